"""One metric per family: `prepare` makes inputs, `measure` returns errors, lower is better."""
