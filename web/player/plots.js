// Plots over time under the same cursor as the animation.

import uPlot from "uplot";

const HEIGHT = 130;  // px
const MOST = 12;  // curves of a plot that are named in its legend

export class Plots {
  constructor(holder, content, flights, palette) {
    Object.assign(this, { holder, content, flights, palette, plots: [], time: 0 });
    this.build(flights[0]);
  }

  /** Draw all plots; those of one vehicle's parts show `followed`. */
  build(followed) {
    this.followed = followed;
    for (const plot of this.plots) plot.destroy();
    this.holder.replaceChildren();
    const style = getComputedStyle(this.holder);
    this.ink = style.color;
    this.faint = style.getPropertyValue("--grid") || "#8884";
    this.plots = this.content.map((panel) => this.#draw(panel)).filter(Boolean);
    this.show(this.time);
  }

  #draw(panel) {
    const single = panel.curves.some((curve) => curve.part);
    const curves = panel.curves.filter(({ flight }) =>
      this.flights[flight].shown && (!single || this.flights[flight] === this.followed));
    if (!curves.length) return null;
    const series = [{}], data = [panel.time];
    curves.forEach((curve, i) => {
      const flight = this.flights[curve.flight];
      series.push({
        label: curve.part || flight.name,
        stroke: curve.part ? this.palette[i % this.palette.length] : flight.colour,
        dash: curve.part ? [] : flight.dash,
        width: 1.3, points: { show: false },
        value: (_, value) => (value === null ? "" : Number(value.toPrecision(4)).toString()),
      });
      data.push(Array.from(curve.values, (value) => (Number.isFinite(value) ? value : null)));
    });
    const box = document.createElement("div");
    box.className = "plot";
    const title = document.createElement("p");
    title.textContent = panel.name + (single && this.flights.length > 1 ? `: ${this.followed.name}` : "");
    box.append(title);
    this.holder.append(box);
    const axis = { stroke: this.ink, grid: { stroke: this.faint, width: 1 }, ticks: { stroke: this.faint, width: 1 } };
    return new uPlot({
      width: Math.max(200, this.holder.clientWidth), height: HEIGHT,
      scales: { x: { time: false, range: () => this.#range() }, y: { range: (_, low, high) => chooseRange(low, high, panel.least) } },
      axes: [{ ...axis, size: 28 }, { ...axis, size: 62, values: (_, ticks) => ticks.map(format) }],
      series,
      legend: { show: curves.length <= MOST && single, live: true },
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false }, bind: { mouseleave: () => null } },
      hooks: { draw: [(plot) => this.#drawMarks(plot, panel)] },
    }, data, box);
  }

  #range() {
    const flown = this.flights.filter((flight) => flight.rows);
    const begin = Math.min(...flown.map((flight) => flight.begin));
    const end = Math.max(...flown.map((flight) => flight.end));
    return end > begin ? [begin, end] : [0, 1];
  }

  #drawMarks(plot, panel) {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.strokeStyle = this.ink;
    ctx.setLineDash([3, 3]);
    ctx.globalAlpha = 0.6;
    const line = (x1, y1, x2, y2) => { ctx.beginPath(); ctx.moveTo(x1, y1); ctx.lineTo(x2, y2); ctx.stroke(); };
    for (const event of this.followed.events || []) {
      const x = plot.valToPos(event.time, "x", true);
      if (x >= bbox.left && x <= bbox.left + bbox.width) line(x, bbox.top, x, bbox.top + bbox.height);
    }
    for (const limit of panel.limits || []) {
      const y = plot.valToPos(limit, "y", true);
      if (y >= bbox.top && y <= bbox.top + bbox.height) line(bbox.left, y, bbox.left + bbox.width, y);
    }
    ctx.restore();
  }

  /** Move the cursor of every plot to a time. */
  show(t) {
    this.time = t;
    for (const plot of this.plots) plot.setCursor({ left: plot.valToPos(t, "x"), top: 0 }, false);
  }

  /** Replace the rows of a flight that still goes on. */
  replace(content) {
    this.content = content;
    this.build(this.followed);
  }

  resize() {
    for (const plot of this.plots) plot.setSize({ width: Math.max(200, this.holder.clientWidth), height: HEIGHT });
    this.show(this.time);
  }

  /** Return the time under a pointer, or null beside the plots. */
  static timeAt(plot, x) {
    const { left, width } = plot.over.getBoundingClientRect();
    return x < left || x > left + width ? null : plot.posToVal(x - left, "x");
  }
}

/** Choose a range in which rounding noise is a flat line. */
function chooseRange(low, high, least) {
  if (low === null || high === null) return [0, 1];
  if (high - low < least) return [(low + high - 2 * least) / 2, (low + high + 2 * least) / 2];
  const margin = 0.06 * (high - low);
  return [low - margin, high + margin];
}

function format(value) {
  if (value === null) return "";
  const isShort = value === 0 || Math.abs(value) >= 1e-3;
  return isShort ? Number(value.toPrecision(6)).toString() : value.toExponential().replace("e-", "e\u2212");
}
