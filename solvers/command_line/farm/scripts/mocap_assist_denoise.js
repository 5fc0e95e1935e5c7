// Made of mocap_assist.js and the options of the verb: make docs.
// Job type of Flamenco 3: a batch of Mocap Assist in parts, one task each. See docs/technical/farm.md.
// Copy it into the folder "scripts" next to the Flamenco Manager.

const JOB_TYPE = {
  label: "Mocap Assist: denoise",
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
    {"key": "preset", "type": "string", "default": "", "required": false, "description": "Named values of some settings; other options replace them [light, normal, heavy, optical, suit, video-ai, depth-camera]"},
    {"key": "train", "type": "string", "default": "", "required": false, "description": "Clean clips to learn from [default: patterns of the take itself]"},
    {"key": "bases", "type": "string", "subtype": "file_path", "default": "", "required": false, "description": "Bases learned from clean clips by the verb learn or the button Learn"},
    {"key": "library", "type": "string", "subtype": "file_path", "default": "", "required": false, "description": "A clip library, made by the verb index; each take uses the clips that are similar to it"},
    {"key": "joint_limits", "type": "string", "choices": ["", "yes"], "default": "", "required": false, "description": "Limit joints softly to the range of rotation in the clips of --train"},
    {"key": "unswap", "type": "string", "choices": ["", "yes"], "default": "", "required": false, "description": "Correct swapped and wrong labels of optical markers first"},
    {"key": "feet", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Plant standing feet [default: where there are feet]"},
    {"key": "method", "type": "string", "default": "", "required": false, "description": "Denoising method; the default performed best in tests [default default]"},
    {"key": "strength", "type": "string", "default": "", "required": false, "description": "Blend from recorded to cleaned motion; gaps are filled at any strength [0 to 1, default 1]"},
    {"key": "strength_arms", "type": "string", "default": "", "required": false, "description": "Fraction of Strength for shoulders and arms [0 to 1, default 1]"},
    {"key": "strength_hands", "type": "string", "default": "", "required": false, "description": "Fraction of Strength for hands and fingers [0 to 1, default 1]"},
    {"key": "strength_head", "type": "string", "default": "", "required": false, "description": "Fraction of Strength for neck, head and face [0 to 1, default 1]"},
    {"key": "strength_legs", "type": "string", "default": "", "required": false, "description": "Fraction of Strength for legs, feet and toes [0 to 1, default 1]"},
    {"key": "strength_trunk", "type": "string", "default": "", "required": false, "description": "Fraction of Strength for hips, spine and the path of the body [0 to 1, default 1]"},
    {"key": "frame_rate", "type": "string", "default": "", "required": false, "description": "Frame rate of the stored patterns; higher keeps faster movements [Hz, 5 to 240, default 30]"},
    {"key": "window", "type": "string", "default": "", "required": false, "description": "Length of the motion patterns; longer patterns cover more of a movement [s, 0.1 to 3, default 0.666667]"},
    {"key": "blend", "type": "string", "default": "", "required": false, "description": "Time to blend a planted foot back to its own motion; higher is softer and longer [s, 0.02 to 2, default 0.3]"},
    {"key": "floor", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Level planted feet that are near the floor, all at one height [default yes]"},
    {"key": "hands_and_knees", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Also keep hands and knees on the floor in place, and hips where they are keyed [default yes]"},
    {"key": "hold", "type": "string", "default": "", "required": false, "description": "Longest time a sliding foot stays fixed before it may slide on; higher is stricter [s, 0.5 to 1000, default 10]"},
    {"key": "hold_rotation", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Also keep feet that stand flat from turning and tilting [default yes]"},
    {"key": "move_root", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Shift the hips slightly and smoothly where a leg cannot reach [default yes]"},
    {"key": "softness", "type": "string", "default": "", "required": false, "description": "Fraction of the leg length held in reserve; higher bends knees and lowers hips more [0 to 0.2, default 0.01]"},
    {"key": "spare_knees", "type": "string", "choices": ["", "yes", "no"], "default": "", "required": false, "description": "Shift hips and heels slightly so that knees bend smoothly [default yes]"},
  ],
};

const OPTIONS = {
  scale: ["one", "--scale"],
  body: ["one", "--body"],
  forward: ["one", "--forward"],
  height: ["one", "--height"],
  unit: ["one", "--unit"],
  up: ["one", "--up"],
  preset: ["one", "--preset"],
  train: ["many", "--train"],
  bases: ["one", "--bases"],
  library: ["one", "--library"],
  joint_limits: ["switch", "--joint-limits", ""],
  unswap: ["switch", "--unswap", ""],
  feet: ["switch", "--feet", "--no-feet"],
  method: ["one", "--method"],
  strength: ["one", "--strength"],
  strength_arms: ["one", "--strength-arms"],
  strength_hands: ["one", "--strength-hands"],
  strength_head: ["one", "--strength-head"],
  strength_legs: ["one", "--strength-legs"],
  strength_trunk: ["one", "--strength-trunk"],
  frame_rate: ["one", "--frame-rate"],
  window: ["one", "--window"],
  blend: ["one", "--blend"],
  floor: ["switch", "--floor", "--no-floor"],
  hands_and_knees: ["switch", "--hands-and-knees", "--no-hands-and-knees"],
  hold: ["one", "--hold"],
  hold_rotation: ["switch", "--hold-rotation", "--no-hold-rotation"],
  move_root: ["switch", "--move-root", "--no-move-root"],
  softness: ["one", "--softness"],
  spare_knees: ["switch", "--spare-knees", "--no-spare-knees"],
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
        ["denoise", "--manifest", settings.manifest],
        ["--output-folder", settings.output_folder, "--shard", part, "--report", "--wait"],
        optionWords(settings),
        shellSplit(settings.options || "")
      ),
    }));
    job.addTask(task);
  }
}
