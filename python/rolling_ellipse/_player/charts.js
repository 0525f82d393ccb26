// Charts next to the film: the axes of a map, and curves over time. Needs strip.js.

/** The part of a canvas that a map fills [CSS px]. */
export function cellsOf({ clientWidth, clientHeight }) {
  const [left, top] = [52, 10];
  return { left, top, across: clientWidth - left - 12, up: clientHeight - top - 36 };
}

/** Label the axes of a map with names, and with values at fractions of its width and height. */
export function paintSides(ink, { grey }, { left, top, across, up }, xs, ys, names) {
  for (const [part, value] of xs)
    text(ink, grey, round(value), left + part * across, top + up + 14, "center", 11);
  for (const [part, value] of ys)
    text(ink, grey, round(value), left - 5, top + up - part * up + 4, "right", 11);
  text(ink, grey, names[0], left + across / 2, top + up + 30, "center", 11);
  ink.save();
  ink.translate(14, top + up / 2);
  ink.rotate(-Math.PI / 2);
  text(ink, grey, names[1], 0, 0, "center", 11);
  ink.restore();
}

/** Mark a rectangle of a map. */
export function paintCursor(ink, colours, ...box) {
  for (const [strokeStyle, lineWidth] of [[colours.paper, 5], [colours.ink, 2]]) {
    Object.assign(ink, { strokeStyle, lineWidth });
    ink.strokeRect(...box);
  }
}

/** A curve through points [s, value], with its least and largest value. */
export function curveOf(points) {
  const values = points.map(([, value]) => Number(value.toFixed(3)));
  return { points, least: Math.min(...values), most: Math.max(...values) };
}

/** The ticks of an axis, in steps of 1, 2 or 5 times a power of ten. */
function ticksOf(low, high) {
  const least = (high - low) / 7, power = 10 ** Math.floor(Math.log10(least));
  const step = power * [1, 2, 5, 10].find((n) => n * power >= least * (1 - 1e-12));
  const first = Math.ceil(low / step), count = Math.floor(high / step) - first + 1;
  return Array.from({ length: count }, (_, i) => (first + i) * step);
}

/** Draw curves over time from 0 to `end`, each with name, colour and dash. Vertical lines mark the
 * impacts and the current time. */
export function paintCurves(ink, colours, canvas, curves, { low, high, end, now, impacts }) {
  const [left, top] = [44, 18], across = canvas.clientWidth - left - 14;
  const up = canvas.clientHeight - top - 24;
  const x = (time) => left + (time / end) * across;
  const y = (part) => top + up * ((high - Math.min(high, Math.max(low, part))) / (high - low));
  for (const tick of ticksOf(low, high)) {
    line(ink, colours.faint, 1, [[left, y(tick)], [left + across, y(tick)]]);
    text(ink, colours.grey, round(tick), left - 6, y(tick) + 4, "right", 11);
  }
  text(ink, colours.grey, "0", left, top + up + 16, "center", 11);
  text(ink, colours.grey, `${round(end)} s`, left + across, top + up + 16, "right", 11);
  ink.lineJoin = "round";
  curves.forEach(({ name, colour, dash, points }, k) => {
    ink.setLineDash(dash);
    line(ink, colours[colour], 1.8, points.map(([time, value]) => [x(time), y(value)]));
    const place = left + across + 6 + 46 * (k - curves.length);
    line(ink, colours[colour], 1.8, [[place, top - 9], [place + 22, top - 9]]);
    ink.setLineDash([]);
    text(ink, colours.ink, name, place + 31, top - 5);
  });
  const upright = (colour, time) => line(ink, colour, 1, [[x(time), top], [x(time), top + up]]);
  for (const time of impacts) upright(colours.plum, time);
  upright(colours.ink, now);
}
