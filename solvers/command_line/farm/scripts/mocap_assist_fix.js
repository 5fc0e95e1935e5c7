// Made of mocap_assist.js and the options of the verb: make docs.
// Job type of Flamenco 3: a batch of Mocap Assist in parts, one task each. See docs/technical/farm.md.
// Copy it into the folder "scripts" next to the Flamenco Manager.

const JOB_TYPE = {
  label: "Mocap Assist: fix",
  description: "Fix, clean or convert takes of captured motion",
  settings: [
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
    {"key": "scale", "type": "string", "default": "", "required": false, "description": "Meters per unit of the input files, instead of --unit [default: as stored in the file, or estimated from the size of the body]"},
    {"key": "body", "type": "string", "default": "", "required": false, "description": "Body to read from input files with several: its name or number, several with commas, or all [default: the person seen in most frames]"},
    {"key": "forward", "type": "string", "default": "", "required": false, "description": "Axis of the file along which the actor faces; it becomes -Y, the front view [default auto]"},
    {"key": "height", "type": "string", "default": "", "required": false, "description": "Stature of the actor for SMPL files, which have no bone lengths [m, 0.1 to 9, default 1.75]"},
    {"key": "unit", "type": "string", "default": "", "required": false, "description": "Length unit of the files; the import message reports what Auto found [guess, metres, centimetres, millimetres, inches, feet, default guess]"},
    {"key": "up", "type": "string", "default": "", "required": false, "description": "Axis of the file that points up; set it if the actor lies on the floor [default auto]"},
    {"key": "place_on_floor", "type": "string", "default": "", "required": false, "description": "Move the take so that the lowest level the actor stands on is height 0 [default auto]"},
    {"key": "physics", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Finish with a simulated body with weight and muscles; takes longer [default no]"},
    {"key": "plant_feet", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Keep planted feet from sliding by moving legs and hips slightly [default yes]"},
  ],
};

const OPTIONS = {
  scale: ["one", "--scale"],
  body: ["one", "--body"],
  forward: ["one", "--forward"],
  height: ["one", "--height"],
  unit: ["one", "--unit"],
  up: ["one", "--up"],
  place_on_floor: ["one", "--place-on-floor"],
  physics: ["switch", "--physics", "--no-physics"],
  plant_feet: ["switch", "--plant-feet", "--no-plant-feet"],
};

function optionWords(settings) {
  let words = [];
  for (const key in OPTIONS) {
    const [kind, name, opposite] = OPTIONS[key], value = settings[key];
    if (!value) {
      continue;
    }
    if (kind === "switch") {
      words = words.concat(value === "no" ? opposite || [] : name);
    } else if (kind === "many") {
      words = words.concat(name, shellSplit(value));
    } else {
      words = words.concat(name + "=" + value);
    }
  }
  return words;
}

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
        ["fix", "--manifest", settings.manifest],
        ["--output-folder", settings.output_folder, "--shard", part, "--report", "--wait"],
        optionWords(settings),
        shellSplit(settings.options || "")
      ),
    }));
    job.addTask(task);
  }
}
