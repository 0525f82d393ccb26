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
const ENDS = { slip: "SLIPS", "lift off": "LOSES_CONTACT", jam: "JAMS" }; // of rolling
const [ROLLING, REST] = [0, 3]; // of Mode, beside those of strip.js
const [VALID, EDGE] = [0, 2]; // of Validity

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
  return found;
}

/** The first outcome, its headline and its reasons, as keys of words with their numbers. */
export function told(motion, scene) {
  const { start, landed, ground, proof, events, ending, until } = motion;
  const { friction: mu } = scene, effect = effectOf(start, scene);
  const headline = [], reasons = [[effect, { ...start, mu }]];
  if (Number.isNaN(landed))
    return { name: "IN_THE_AIR", reasons, headline: [[events.length ? "bounces" : "flies_on"]] };
  if (!start.touching) headline.push(["lands", { t: landed }]);
  const name = OUTCOMES[proof.outcome];
  const rolls = ground.mode === ROLLING || ground.mode === REST;
  headline.push(rolls ? endOf(events, name, landed)
    : [`${name}_${start.touching ? "now" : "then"}`]);
  const after = motionAfter(ground, mu);
  if (after) reasons.push([after, { mu }]);
  if (rolls) {
    const why = whyOf(proof, ground.mode, mu), angle = Number.isNaN(proof.ends) ? proof.angle
      : proof.ends;
    reasons.push([why, { ...proof, mu, angle: (angle * 180) / Math.PI }]);
    if (why !== "ends_grip") reasons.push([mu === Infinity ? "unlimited" : "friction", { mu }]);
    const needed = effect === "sticks" ? neededBy(start, scene) : 0;
    if (needed > 0 && needed < Infinity) reasons.push(["blow_needs", { needed }]);
  }
  if (ending !== COMPLETED && (name !== "JAMS" || until > landed))
    reasons.push([{ [JAMMED]: "jammed", [UNDETERMINED]: "undetermined" }[ending] ?? "given_up",
      { t: until }]);
  return { name, headline, reasons };
}

function effectOf(start, { jx, friction }) {
  if (start.slip_removed) return "stopped";
  if (jx === null) return "no_blow";
  if (!start.touching) return "in_the_air";
  const slides = friction === Infinity ? "lifted" : "slides_off";
  return { [FLIGHT]: "thrown", [SLIDING]: slides }[start.by_velocity] ?? "sticks";
}

/** How rolling ends, and when if the motion was followed so far. */
function endOf(events, name, since) {
  const end = events.find(([t, kind]) => t > since && kind in ENDS);
  if (end) return [`${name === "JAMS" ? name : ENDS[end[1]]}_at`, { t: end[0] }];
  return [`${name}_${Object.values(ENDS).includes(name) ? "later" : "now"}`];
}

/** Why the motion is not the one that the velocities at the start suggest. */
function motionAfter({ may_fly, paradox, mode, by_velocity }, friction) {
  if (may_fly) return "wedged";
  if (paradox) return ["", "no_motion", "two_motions"][paradox];
  if (mode === by_velocity || mode === REST) return "";
  return mode === SLIDING && friction < Infinity ? "no_grip" : "pulled";
}

/** What proves that the body rolls for ever, or ends its rolling. */
function whyOf({ validity, ends, angle, ratio }, mode, friction) {
  if (!Number.isNaN(ends))
    return validity === EDGE ? "on_edge" : friction === Infinity ? "ends_pull" : "ends_grip";
  if (mode === REST) return "stays";
  return Number.isNaN(angle) || validity !== VALID || ratio === Infinity ? "rolls" : "proved";
}

/** Friction for a blow whose contact sticks, and for a slip that it stops not to start again. */
function neededBy({ along, up }, { a, b, mass, inertia, theta }) {
  const [h, lead] = support(theta, a, b), k2 = inertia ? inertia / mass : (a * a + b * b) / 4;
  return Math.max(Math.abs(along) / up, Math.abs(h * lead) / (k2 + h * h));
}
