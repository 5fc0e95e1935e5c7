"""A custom property is parsed when it has changed, not at each redraw."""


def test_history_is_parsed_once_until_it_changes(blank, load, monkeypatch):
    stored, history = (
        load("mocap_assist.blender.stored_json"),
        load("mocap_assist.scene.history"),
    )
    parsed, parse_json = [], stored.parse_json
    monkeypatch.setattr(
        stored,
        "parse_json",
        lambda text, **rest: parsed.append(text) or parse_json(text, **rest),
    )
    action = blank.data.actions.new("walk")
    entries = [{"operation": "clean", "test": "parsed once"}]
    stored.store_json(action, history.HISTORY, entries)

    assert [history.history(action) for _ in range(3)] == [entries] * 3
    assert len(parsed) == 1
    stored.store_json(action, history.HISTORY, entries * 2)
    assert history.history(action) == entries * 2
    assert len(parsed) == 2
