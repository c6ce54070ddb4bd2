// One axis under every drawing; app/web/charts/axis.py works out the same on the server, and a test proves it.

import { facts } from "./facts.js";
import { clockTime, dayIn, offsetS } from "./format.js";

const NEARLY = 1e-9;
const { numbers, angles_deg: angles, times_s: spans } = facts.steps;
const [MINUTE_S, DAY_S] = [60, 86_400];

// Where values lie, as a drawing tells it: `low high start end`.
export function scaleOf(data) {
  const [low, high, start, end] = data.split(" ").map(Number);
  return { low, high, at: (value) => start + ((end - start) * (value - low)) / (high - low) };
}

export function numberStep(span, most) {
  const rough = Math.max(span, NEARLY) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  return numbers.find((step) => step * power >= rough * (1 - NEARLY)) * power;
}

export function angleStep(span, most) {
  return span / most <= angles[0] / 2 ? numberStep(span, most) : least(angles, span, most);
}

export const timeStepS = (span, most) => least(spans, span, most);

const least = (steps, span, most) => steps.find((step) => span / step <= most * (1 + NEARLY)) ?? steps.at(-1);

// Round values between two.
export function within(low, high, most, stepOf = numberStep) {
  const step = stepOf(high - low, most);
  const [first, last] = [Math.ceil(low / step - NEARLY), Math.floor(high / step + NEARLY)];
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, index) => Number(((first + index) * step).toFixed(9)));
}

// Instants between two, in Unix seconds, at which the clocks of a zone show round times.
export function times(begin, end, most, zone) {
  const step = timeStepS(end - begin, most);
  const found = [];
  let local = Math.ceil((begin + offsetS(begin, zone)) / step) * step;
  for (;;) {
    const at = local - offsetS(local - offsetS(local, zone), zone);
    if (at > end) return found;
    if (at >= begin && at > (found.at(-1) ?? -Infinity)) found.push(at);
    local += step;
  }
}

// The time at an axis: of a span of days the day where it begins, of a span of seconds these too.
export function timeAt(seconds, zone, spanS) {
  const begins = (seconds + offsetS(seconds, zone)) % DAY_S === 0;
  if (begins && spanS > DAY_S) return dayIn(seconds * 1000, zone);
  return clockTime(seconds * 1000, zone, seconds % MINUTE_S !== 0);
}
