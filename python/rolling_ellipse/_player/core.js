// The exact core as WebAssembly: a scene and times in; samples, events and facts out. All numbers
// are in SI units. It needs track.js.

const SCENE = ["a", "b", "mass", "gravity", "slope", "friction", "restitution", "theta", "omega",
  "x", "inertia", "z", "x_dot", "z_dot", "jx", "jz", "dx", "dz"]; // an absent one is null
const START = ["touching", "by_velocity", "mode", "paradox", "may_fly", "slip_removed", "energy",
  "along", "up", "omega"];
const PROOF = ["outcome", "validity", "N", "angle", "ratio", "ends"];
const SAMPLE = ["x", "z", "theta", "x_dot", "z_dot", "omega", "normal_force", "friction_force",
  "mode", "kinetic", "potential"];
const KINDS_OF_EVENT = ["slip", "stick", "reverse", "lift off", "impact", "rest", "jam"];
const OUTCOMES = ["RESTS", "ROCKS", "ROLLS_OVER", "SLIPS", "LOSES_CONTACT", "JAMS", "EDGE"];
export const [COMPLETED, JAMMED, UNDETERMINED] = [0, 5, 6]; // codes of Ending
const [ROLLING, REST] = [0, 3]; // of Mode, beside those of strip.js
const [VALID, EDGE, NO_PROOF] = [0, 2, 3]; // of Validity

export class Core {
  /** The core from its bytes; an error where the page may not use WebAssembly. */
  static async of(bytes) {
    const nothing = new Proxy({}, { get: () => () => 0 }); // the core asks its system for nothing
    const { instance } = await WebAssembly.instantiate(bytes,
      { env: nothing, wasi_snapshot_preview1: nothing });
    instance.exports._initialize();
    return Object.assign(new Core(), { exports: instance.exports });
  }

  /** The motion of a scene up to an end, with samples at some times, and facts if wanted. */
  motion(scene, end, times = [], facts = false) {
    const { memory, malloc, free, live } = this.exports;
    const asked = [...SCENE.map((name) => scene[name] ?? NaN), end, facts ? 1 : 0, ...times];
    const place = malloc(8 * asked.length);
    new Float64Array(memory.buffer, place, asked.length).set(asked);
    const answer = live(place, times.length); // each call may make memory grow
    free(place);
    const [length] = new Float64Array(memory.buffer, answer, 1);
    const numbers = new Float64Array(memory.buffer, answer, length).slice(1);
    if (Number.isNaN(numbers[0])) throw new RangeError(wordsOf(numbers.subarray(1)));
    return read(numbers, facts, times.length);
  }
}

const wordsOf = (letters) => new TextDecoder().decode(Uint8Array.from(letters));

function read(numbers, facts, samples) {
  let next = 0;
  const named = (names) => Object.fromEntries(names.map((name) => [name, numbers[next++]]));
  const found = { ...named(["ending", "until"]), events: [] };
  for (let left = numbers[next++]; left > 0; left--) {
    const [t, kind, x] = numbers.subarray(next, (next += 3));
    found.events.push([t, KINDS_OF_EVENT[kind], x]);
  }
  if (facts) {
    found.start = named(START);
    Object.assign(found, named(["landed"]), { ground: named(START), proof: named(PROOF) });
  }
  found.columns = Object.fromEntries(SAMPLE.map((name) => [name, new Float64Array(samples)]));
  for (let i = 0; i < samples; i++)
    for (const name of SAMPLE) found.columns[name][i] = numbers[next++];
  found.reason = wordsOf(numbers.subarray(next));
  return found;
}

/** The first outcome, its headline and its reasons, as keys of words with their numbers. */
export function told(motion, { friction, jx }) {
  const { start, landed, ground, proof, ending, until } = motion;
  const headline = [], reasons = [[effectOf(start, jx), { ...start, mu: friction }]];
  if (Number.isNaN(landed))
    return { name: "IN_THE_AIR", reasons, headline: [[motion.events.length ? "bounces"
      : "flies_on"]] };
  if (!start.touching) {
    headline.push(["lands"]);
    reasons.push(["landed", { t: landed }]);
  }
  const name = OUTCOMES[proof.outcome];
  const later = (ground.mode === ROLLING || ground.mode === REST)
    && ["SLIPS", "LOSES_CONTACT", "JAMS"].includes(name);
  headline.push([`${name}_${later ? "later" : "now"}`]);
  const after = motionAfter(ground, friction);
  if (after) reasons.push([after, { mu: friction }]);
  if (ground.mode === ROLLING && proof.validity !== NO_PROOF)
    reasons.push([why(proof, friction), { ...proof, mu: friction,
      angle: Number.isNaN(proof.ends) ? proof.angle : proof.ends }]);
  if (ending !== COMPLETED)
    reasons.push([{ [JAMMED]: "jammed", [UNDETERMINED]: "undetermined" }[ending] ?? "given_up",
      { t: until }]);
  return { name, headline, reasons };
}

function effectOf(start, jx) {
  if (start.slip_removed) return "stopped";
  if (jx === null) return "no_blow";
  if (!start.touching) return "in_the_air";
  return { [FLIGHT]: "thrown", [SLIDING]: "slides_off" }[start.by_velocity] ?? "sticks";
}

/** Why the motion is not the one that the velocities at the start suggest. */
function motionAfter({ may_fly, paradox, mode, by_velocity }, friction) {
  if (may_fly) return "wedged";
  if (paradox) return ["", "no_motion", "two_motions"][paradox];
  if (mode === by_velocity || mode === REST) return "";
  return mode === SLIDING && friction < Infinity ? "no_grip" : "pulled";
}

/** What proves that the body rolls for ever, or ends its rolling. */
function why({ validity, ends, angle }, friction) {
  if (!Number.isNaN(ends))
    return validity === EDGE ? "on_edge" : friction === Infinity ? "ends_pull" : "ends_grip";
  return Number.isNaN(angle) || validity !== VALID ? "rolls" : "proved";
}
