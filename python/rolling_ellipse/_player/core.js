// The exact core as WebAssembly: it turns a scene into samples, events and sentences. All numbers
// are in SI units. A scene may have `blows` during its motion: rows of t, jx, jz, dx and dz. This
// module needs no other module.

const [FEWEST, MOST, TURN] = [300, 3000, 0.2]; // fewest and most intervals, turn in each [rad]

export class Core {
  /** Load the core from its bytes; throws an error if the page may not use WebAssembly. */
  static async of(bytes) {
    const nothing = new Proxy({}, { get: () => () => 0 }); // stubs: the core uses no system services
    const { instance } = await WebAssembly.instantiate(bytes,
      { env: nothing, wasi_snapshot_preview1: nothing });
    instance.exports._initialize();
    return new Core(instance.exports);
  }

  constructor(exports) {
    this.exports = exports;
    this.names = JSON.parse(this.text(exports.columns()));
  }

  text(place) {
    const bytes = new Uint8Array(this.exports.memory.buffer, place);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** Call a function of the core with an array of numbers. */
  call(name, numbers, more) {
    const { malloc, free } = this.exports, place = malloc(8 * numbers.length);
    new Float64Array(this.exports.memory.buffer, place, numbers.length).set(numbers);
    const answer = this.exports[name](place, more); // any call may grow the memory
    free(place);
    return answer;
  }

  /** The numbers that a call passes: those of the scene, the end time, and the blows. */
  numbers(scene, end) {
    const { blows = [] } = scene, numbers = this.names.scene.map((name) => scene[name] ?? NaN);
    return [...numbers, end, blows.length, ...blows.flat()];
  }

  /** Simulate a scene up to `end`, with sentences if requested; a RangeError says what is wrong. */
  ask(scene, end, inWords = true) {
    const answer = this.text(this.call("ask", this.numbers(scene, end), inWords));
    if (!answer.startsWith("{")) throw new RangeError(answer);
    const found = JSON.parse(answer);
    for (const event of found.events) event[1] = event[1].toLowerCase().replace("_", " ");
    if (found.blow) found.headline.unshift(["after_the_blow", { t: found.blow }]);
    return found;
  }

  /** The first outcome after the last blow, as `ask` would report it. `samples` still samples the
   * motion of `ask`. */
  first(scene, end) {
    const answer = this.text(this.call("first", this.numbers(scene, end)));
    if (answer !== answer.toUpperCase()) throw new RangeError(answer);
    return answer;
  }

  /** Samples of the last motion at the given times, as columns by name. */
  samples(times) {
    const { sample: names } = this.names, place = this.call("samples", times, times.length);
    const rows = new Float64Array(this.exports.memory.buffer, place, names.length * times.length);
    return Object.fromEntries(names.map((name, k) =>
      [name, Float64Array.from(times, (_, i) => rows[i * names.length + k])]));
  }

  /** The motion of a scene up to an end: the answer of `ask`, times, samples, and a track. */
  motion(scene, end) {
    const found = this.ask(scene, end), times = this.timesOf(found, scene.theta);
    const columns = this.samples(times);
    return { found, times, columns, track: trackOf(times, columns) };
  }

  /** Ends and middles of intervals in turn; events, and times just before them, are ends. */
  timesOf({ until, events }, theta) {
    if (!until) return Float64Array.of(0);
    const turn = Math.abs(this.samples([until]).theta[0] - theta);
    const count = Math.max(FEWEST, Math.min(MOST, Math.ceil(turn / TURN)));
    const even = Array.from({ length: count + 1 }, (_, i) => (i / count) * until);
    const jumps = events.map(([t]) => t).filter((t) => t > 0 && t < until);
    const ends = Float64Array.of(...even, ...jumps, ...jumps.map((t) => t * (1 - Number.EPSILON)))
      .sort().filter((t, i, sorted) => t !== sorted[i - 1]);
    return Float64Array.from({ length: 2 * ends.length - 1 }, (_, i) =>
      (ends[Math.floor(i / 2)] + ends[Math.ceil(i / 2)]) / 2);
  }
}

/** Columns for a track; in the middle of a jump, a force has the mean of both values. */
function trackOf(times, columns) {
  const isEnd = (_, i) => i % 2 === 0, track = { t: times.filter(isEnd) };
  for (const name in columns) track[name] = columns[name].filter(isEnd);
  for (const name of ["normal_force", "friction_force"]) {
    const values = columns[name], last = values.length - 1, end = times[last];
    track[`${name}_middle`] = track[name].map((value, n) => {
      const [middle, next] = [Math.min(2 * n + 1, last), Math.min(2 * n + 2, last)];
      const jumps = times[next] - times[2 * n] <= 1e-9 * end;
      return jumps ? (value + values[next]) / 2 : values[middle];
    });
  }
  return track;
}
