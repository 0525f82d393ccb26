// Draws one strip of the picture: a body in a given state, on ground with a ruler. Needs track.js.

export const [SLIDING, FLIGHT] = [1, 2]; // codes of Mode
const SHOWN = 6000; // largest number of points drawn of a trace; earlier ones are out of sight
const ROW = 17; // height of a line of a caption [px]
const FADES = 1.2; // how long a blow or an event stays visible [seconds of film]

/** Maps points of a strip, in its ground axes, to pixels (`at`) and back (`ground`). */
export class View {
  constructor(strip, window, place, floor, width) {
    const [left, right, , top] = window;
    this.scale = width / (right - left);
    const c = this.scale * Math.cos(strip.slope), s = this.scale * Math.sin(strip.slope);
    const [x, y] = place;
    this.at = (px, pz) => [c * px + s * pz - this.scale * (left + x),
      s * px - c * pz + this.scale * (top + y) + floor];
    this.ground = (px, py) => {
      const u = px + this.scale * (left + x), w = py - floor - this.scale * (top + y);
      return [(c * u + s * w) / this.scale ** 2, (s * u - c * w) / this.scale ** 2];
    };
  }
}

/** Draw one motion as it is at a given time. */
export function paintStrip(ink, colours, strip, at, view, shown) {
  ink.lineJoin = "round";
  paintGround(ink, colours, strip, view, shown);
  paintSkids(ink, colours, strip, at, view);
  paintTrace(ink, colours.blue, 1, strip, ({ tip }) => tip, at, view, 0.55);
  paintBody(ink, colours, strip, at, view);
  paintTrace(ink, colours.orange, 1.8, strip, ({ x, z }) => [x, z], at, view, 1);
  paintContact(ink, colours, strip, at, view);
  if (shown.forces) paintForces(ink, colours, strip, at, view);
  paintBlow(ink, colours, strip, at, view, shown.lasting);
  paintEvents(ink, colours, strip, at, view, shown);
  paintTexts(ink, colours.ink, shown);
}

/** Write the clock, and the caption beside it or, if strips are side by side, below it. */
function paintTexts(ink, colour, { caption, clock, beside, floor, width }) {
  text(ink, colour, clock, width - 12, floor + 20, "right");
  const room = width - 24 - (beside || !clock ? 0 : ink.measureText(clock).width + 12);
  caption.split("\n").forEach((row, i) => {
    const size = Math.min(13, Math.max(8, 13 * room / ink.measureText(row).width));
    text(ink, colour, row, 12, floor + 20 + (beside ? i + 1 : i) * ROW, "left", size);
  });
}

const font = (size) => `${size}px system-ui, sans-serif`;

export function text(ink, colour, words, x, y, align = "center", size = 13) {
  ink.font = font(size);
  ink.textAlign = align;
  ink.fillStyle = colour;
  ink.fillText(words, x, y);
}

export function path(ink, points) {
  ink.beginPath();
  for (const point of points) ink.lineTo(...point);
}

export function stroke(ink, strokeStyle, lineWidth) {
  Object.assign(ink, { strokeStyle, lineWidth });
  ink.stroke();
}

export function line(ink, colour, width, points) {
  path(ink, points);
  stroke(ink, colour, width);
}

export function fill(ink, colour) {
  ink.fillStyle = colour;
  ink.fill();
}

export const point = { sign: "." }; // decimal point of the page's language

/** The text of a number, rounded to a few digits; a number given as a string is not rounded. */
export function round(value, digits = 3) {
  if (value === Infinity) return "∞";
  const written = typeof value === "number" ? `${+value.toPrecision(digits)}` : `${value}`;
  return /^[-+\d.e]+$/.test(written) ? written.replace("-", "−").replace(".", point.sign) : written;
}

/** Draw an arrow from one pixel to another; the head of a short one is smaller. */
export function arrow(ink, colour, [x, y], [u, v], width = 2.5) {
  const length = Math.hypot(u - x, v - y);
  if (length < 1) return;
  const [c, s] = [(u - x) / length, (v - y) / length], head = Math.min(10, 0.7 * length);
  const corner = (along, across) => [u - c * along - s * across, v - s * along + c * across];
  ink.lineCap = "round";
  line(ink, colour, width, [[x, y], corner(0.8 * head, 0)]);
  path(ink, [[u, v], corner(head, head / 2.4), corner(head, -head / 2.4)]);
  fill(ink, colour);
}

export function disc(ink, colour, edge, [x, y], radius) {
  ink.beginPath();
  ink.arc(x, y, radius, 0, 2 * Math.PI);
  fill(ink, colour);
  if (edge) stroke(ink, edge, 1.5);
}

/** Set the current path to the outline of a body. */
export function outline(ink, strip, at, view) {
  const [u, v] = view.at(at.x, at.z);
  ink.beginPath();
  ink.ellipse(u, v, strip.a * view.scale, strip.b * view.scale, at.theta + strip.slope, 0,
    2 * Math.PI);
}

/** Draw the ground and its ticks; every fifth tick is longer and labelled with its position. */
function paintGround(ink, colours, strip, view, { floor, width, tall }) {
  const far = (2 * (width + tall)) / view.scale;
  const [x] = view.ground(width / 2, floor + tall);
  path(ink, [view.at(x - far, 0), view.at(x + far, 0), view.at(x + far, -far),
    view.at(x - far, -far)]);
  fill(ink, colours.earth);
  line(ink, colours.grey, 1, [view.at(x - far, 0), view.at(x + far, 0)]);
  const span = width / view.scale / Math.cos(strip.slope), least = span / Math.min(24, width / 25);
  const power = 10 ** Math.floor(Math.log10(least));
  const step = power * [1, 2, 5, 10].find((n) => n * power >= least * (1 - 1e-12));
  const first = Math.floor((x - span) / step), last = Math.ceil((x + span) / step);
  const [perMetre, unit] = strip.unit ?? [1, "m"], depth = 8 / view.scale;
  ink.beginPath();
  for (let i = first; i <= last; i++) {
    ink.moveTo(...view.at(i * step, 0));
    ink.lineTo(...view.at(i * step, -depth * (i % 5 ? 0.75 : 1.4)));
  }
  ink.stroke();
  for (let i = Math.ceil(first / 5) * 5; i <= last; i += 5) {
    const place = view.at(i * step, -depth * 3), words = `${round(i * step * perMetre, 10)} ${unit}`;
    ink.font = font(11);
    const half = ink.measureText(words).width / 2;
    if (place[0] < half || place[0] > width - half) continue; // the edge would cut it off
    ink.save();
    ink.translate(...place);
    ink.rotate(strip.slope);
    text(ink, colours.grey, words, 0, 0, "center", 11);
    ink.restore();
  }
}

/** The last SHOWN states of a trace, and the current state. */
function past({ trace }, at) {
  const end = lastUntil(at.t, trace.length, (k) => trace[k].t) + 1;
  return [...trace.slice(Math.max(0, end - SHOWN), end), at];
}

/** Mark the parts of the ground on which the contact has slid. */
function paintSkids(ink, colours, strip, at, view) {
  ink.beginPath();
  let slid = false;
  for (const { x, theta, mode } of past(strip, at)) {
    const place = view.at(x + support(theta, strip.a, strip.b)[1], 0);
    if (slid) ink.lineTo(...place);
    else if (mode === SLIDING) ink.moveTo(...place);
    slid = mode === SLIDING;
  }
  Object.assign(ink, { lineCap: "butt", globalAlpha: 0.5 });
  stroke(ink, colours.plum, 6);
  ink.globalAlpha = 1;
}

/** Draw the trace of a point of the body up to now. */
function paintTrace(ink, colour, width, strip, placeOf, at, view, alpha) {
  ink.globalAlpha = alpha;
  line(ink, colour, width, past(strip, at).map((state) => view.at(...placeOf(state))));
  ink.globalAlpha = 1;
}

function paintBody(ink, colours, strip, at, view) {
  const { a, b } = strip, sine = Math.sin(at.theta), cosine = Math.cos(at.theta);
  if (at.mode === FLIGHT) {
    const half = support(at.theta + Math.PI / 2, a, b)[0];
    ink.lineCap = "round";
    line(ink, colours.grey, 5, [view.at(at.x - half, 0), view.at(at.x + half, 0)]);
  }
  outline(ink, strip, at, view);
  fill(ink, colours.body);
  stroke(ink, colours.ink, 1.8);
  const axis = (x, z) => [-1, 1].map((n) => view.at(at.x + n * x, at.z + n * z));
  line(ink, colours.ink, 1.2, axis(a * cosine, -a * sine));
  ink.setLineDash([5, 4]);
  line(ink, colours.ink, 1.2, axis(b * sine, b * cosine));
  ink.setLineDash([]);
  disc(ink, colours.blue, null, view.at(...at.tip), 4);
}

/** Mark the contact with a disc or, while it slides, a triangle in the direction of slip. */
function paintContact(ink, colours, { a, b }, at, view) {
  if (at.mode === FLIGHT) return;
  const [height, lead] = support(at.theta, a, b), way = Math.sign(at.xDot - height * at.omega);
  const place = at.x + lead, pixel = 1 / view.scale;
  if (at.mode !== SLIDING) {
    disc(ink, colours.paper, colours.ink, view.at(place, 0), 4);
    return;
  }
  path(ink, [[9, 0], [-5.5, 6], [-5.5, -6]].map(([along, up]) =>
    view.at(place + way * along * pixel, up * pixel)));
  ink.closePath();
  fill(ink, colours.plum);
  stroke(ink, colours.paper, 0.8);
}

/** Draw the contact forces; the arrow of a force equal to the weight has the length of the longer
 * semi-axis. */
function paintForces(ink, colours, { a, b, weight }, at, view) {
  if (at.mode === FLIGHT) return;
  const place = at.x + support(at.theta, a, b)[1];
  const length = (force) => Math.max(-3, Math.min(3, force / weight)) * Math.max(a, b);
  const foot = view.at(place, 0), up = view.at(place, length(at.N));
  const along = view.at(place + length(at.F), 0);
  arrow(ink, colours.plum, foot, up, 3);
  arrow(ink, colours.plum, foot, along, 3);
  text(ink, colours.plum, "N", up[0] + 13, up[1] + 8);
  if (Math.abs(at.F) > 0.02 * weight) text(ink, colours.plum, "F", along[0], along[1] - 8);
}

/** Draw the last blow at the place where it struck the body; the arrow fades with time. */
function paintBlow(ink, colours, strip, at, view, lasting) {
  const [t, jx, jz, dx, dz] = strip.blows.filter(([then]) => then <= at.t).pop() ?? [];
  const size = Math.hypot(jx, jz), age = lasting * (1 - t / Math.max(at.t, 1e-300));
  if (!(age <= FADES && size)) return;
  const { x, z } = strip.motion.at(t), long = 0.9 * Math.max(strip.a, strip.b);
  const end = [x + dx, z + dz], start = [end[0] - (long * jx) / size, end[1] - (long * jz) / size];
  const [u, v] = view.at(...start);
  ink.globalAlpha = 1 - age / FADES;
  arrow(ink, colours.plum, [u, v], view.at(...end), 3.5);
  text(ink, colours.plum, `${round(size)} N s`, u + 10, v + 12, "left");
  ink.globalAlpha = 1;
}

/** Draw a tick on the ground for every past event, and the name of the last one for a while. */
function paintEvents(ink, colours, strip, at, view, { width, lasting, say }) {
  let named = null;
  for (const [t, kind, x] of strip.events) {
    if (t > at.t) break;
    const [u, v] = view.at(x, 0);
    if (u < -5 || u > width + 5) continue;
    path(ink, [[u, v], [u - 3.5, v + 8], [u + 3.5, v + 8]]);
    fill(ink, colours.plum);
    const age = lasting * (1 - t / Math.max(at.t, 1e-300));
    if (age < FADES) named = { kind: say(kind), place: [u, v + 38], alpha: 1 - age / FADES };
  }
  if (!named) return;
  ink.globalAlpha = named.alpha;
  text(ink, colours.plum, named.kind, ...named.place, "center", 11);
  ink.globalAlpha = 1;
}
