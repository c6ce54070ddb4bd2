// Charts in the colours of the theme, drawn by uPlot; its styles go through the DOM, so that no inline style is needed.

/* global uPlot */
import { colour } from "./colours.js";
import { angleStep, numberStep, timeAt, times, within } from "./chart_axis.js";
import { clockTime, dayIn, numberOf } from "./format.js";
import { _ } from "./i18n.js";

const tzDate = (zone) => (seconds) => uPlot.tzDate(new Date(seconds * 1000), zone);

const NUMBER_PX = 34;
const TIME_PX = 76;
const ROOM_PX = 58;

// How many numbers an axis has room for; the frame is in pixels of the screen.
const room = (long, each) => Math.max(2, Math.floor(long / devicePixelRatio / each));

// `wanted`: series [{label, colour, width, dash}], zone of the time axis, unit, cursor; angles have no other unit.
// `tickUnit` where the unit stands in the title and not at every tick.
export function chart(holder, wanted) {
  const size = () => ({ width: Math.max(200, holder.clientWidth), height: wanted.height ?? 260 });
  const digits = wanted.digits ?? 2;
  const unit = wanted.unit ?? "°";
  const text = (value) => (value === null || value === undefined ? "–" : `${numberOf(value.toFixed(digits))}${unit}`);
  const font = `14px ${getComputedStyle(document.body).fontFamily}`;
  const axis = { stroke: colour("text"), grid: { stroke: colour("hair"), width: 1 }, ticks: { show: false }, font };
  const plot = new uPlot({
    ...size(),
    tzDate: tzDate(wanted.zone),
    cursor: { points: { size: 9 }, drag: { x: false, y: false }, ...wanted.cursor },
    legend: { live: true },
    scales: { x: { time: true }, y: { range: wanted.range ?? padded } },
    axes: [
      { ...axis, splits: ({ bbox }, _, low, high) => times(low, high, room(bbox.width, TIME_PX), wanted.zone),
        values: ({ scales }, ticks) => ticks.map((at) => timeAt(at, wanted.zone, scales.x.max - scales.x.min)) },
      { ...axis, size: ROOM_PX, splits: ({ bbox }, _, low, high) => within(low, high, room(bbox.height, NUMBER_PX), wanted.unit ? numberStep : angleStep),
        values: (_, ticks) => ticks.map((value) => `${numberOf(value).replace("-", "−")}${wanted.tickUnit ?? unit}`) },
    ],
    series: [
      { label: _("Time"), value: (_, at) => (at === null ? "–" : timeOf(at, wanted)) },
      ...wanted.series.map((one) => ({ label: one.label, stroke: colour(one.colour), width: one.width ?? 2, dash: one.dash, points: { show: false }, value: (_, value) => text(value), spanGaps: false })),
    ],
    hooks: wanted.hooks,
  }, wanted.data ?? [[], ...wanted.series.map(() => [])], holder);
  // Its first word comes at once, when nothing has changed: then there is nothing to draw again.
  const watcher = new ResizeObserver(() => {
    const room = size();
    if (room.width !== plot.width || room.height !== plot.height) plot.setSize(room);
  });
  watcher.observe(holder);
  return plot;
}

// The time of day, and with `days` the month and day before it.
function timeOf(seconds, { zone, days }) {
  const time = clockTime(seconds * 1000, zone);
  return days ? `${dayIn(seconds * 1000, zone)} ${time}` : time;
}

function padded(_, least, most) {
  if (least === null || most === null) return [0, 90];
  const room = Math.max(1, (most - least) * 0.08);
  return [least - room, most + room];
}
