// Job type of Flamenco 3: a batch of Mocap Assist in parts, one task each. See docs/technical/farm.md.
// Copy it into the folder "scripts" next to the Flamenco Manager.

const JOB_TYPE = {
  label: "Mocap Assist",
  description: "Fix, clean or convert takes of captured motion",
  settings: [
    { key: "verb", type: "string", default: "fix", required: true,
      description: "What to do with each take, such as fix, denoise or convert" },
    { key: "manifest", type: "string", subtype: "file_path", required: true,
      description: "The list of takes, one path per line" },
    { key: "output_folder", type: "string", subtype: "dir_path", required: true,
      description: "The folder for the results, their records and the report" },
    { key: "shards", type: "int32", default: 10, propargs: { min: 1, max: 10000 },
      description: "The number of tasks that share the takes" },
    { key: "options", type: "string", default: "", required: false,
      description: "More options of the verb, as on the command line" },
    { key: "command", type: "string", default: "python3 -m solvers", required: true,
      description: "The command of Mocap Assist on the workers; mocap-assist with the Python package" },
  ],
};

function compileJob(job) {
  const settings = job.settings;
  if (settings.shards < 1) {
    throw "shards is " + settings.shards + "; it must be at least 1.";
  }
  const command = [].concat(shellSplit(settings.command));
  for (let number = 1; number <= settings.shards; number++) {
    const part = number + "/" + settings.shards;
    const task = author.Task("part " + part, "misc");
    task.addCommand(author.Command("exec", {
      exe: command[0],
      args: command.slice(1).concat(
        [settings.verb, "--manifest", settings.manifest],
        ["--output-folder", settings.output_folder, "--shard", part, "--report", "--wait"],
        shellSplit(settings.options || "")
      ),
    }));
    job.addTask(task);
  }
}
