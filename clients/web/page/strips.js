// Signals of the last seconds, a small chart each.

const SHOWN_S = 10;

export class Strips {
  constructor(parent) {
    this.parent = parent;
    this.strips = new Map();
  }

  // A value of a series at an instant of its server, s. `range`: of the chart, [low, high].
  push(key, title, unit, range, time_s, value) {
    let strip = this.strips.get(key);
    if (!strip) {
      strip = { points: [], title, unit, range, ...this.figure() };
      this.strips.set(key, strip);
    }
    const last = strip.points.at(-1);
    if (last && time_s < last[0]) strip.points.length = 0;  // Another start of the server.
    strip.points.push([time_s, value]);
    while (strip.points[0][0] < time_s - SHOWN_S) strip.points.shift();
    strip.title = title;
  }

  figure() {
    const figure = document.createElement('figure'), caption = document.createElement('figcaption');
    const canvas = document.createElement('canvas');
    canvas.setAttribute('role', 'img');
    figure.append(caption, canvas);
    this.parent.append(figure);
    return { figure, caption, canvas };
  }

  // Forgets those that nothing has come for.
  draw(now_s) {
    for (const [key, strip] of this.strips) {
      const last = strip.points.at(-1);
      if (!last || last[0] < now_s - SHOWN_S) {
        strip.figure.remove();
        this.strips.delete(key);
        continue;
      }
      const text = `${strip.title}: ${last[1].toFixed(1)} ${strip.unit}`;
      if (strip.caption.textContent !== text) strip.caption.textContent = text;
      strip.canvas.setAttribute('aria-label', text);
      drawStrip(strip, now_s);
    }
  }
}

function drawStrip({ canvas, points, range }, now_s) {
  const ratio = window.devicePixelRatio || 1, style = getComputedStyle(canvas);
  const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const context = canvas.getContext('2d');
  let [low, high] = range;
  for (const [, value] of points) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  const x = time => width * (1 + (time - now_s) / SHOWN_S);
  const y = value => height * (0.95 - 0.9 * (value - low) / (high - low || 1));
  context.clearRect(0, 0, width, height);
  context.strokeStyle = style.getPropertyValue('--edge');
  context.lineWidth = ratio;
  context.beginPath();
  for (const level of [low, high]) {
    context.moveTo(0, y(level));
    context.lineTo(width, y(level));
  }
  context.stroke();
  context.strokeStyle = style.getPropertyValue('--accent');
  context.lineWidth = 1.5 * ratio;
  context.beginPath();
  points.forEach(([time, value], i) => {
    // A pause is not a line.
    if (i > 0 && time - points[i - 1][0] < 0.5) context.lineTo(x(time), y(value));
    else context.moveTo(x(time), y(value));
  });
  context.stroke();
}
