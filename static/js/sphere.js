// The angle between two directions of the sky, degrees.

const RAD = Math.PI / 180;

export function separation(azimuthA, elevationA, azimuthB, elevationB) {
  const half = ((azimuthA - azimuthB) * RAD) / 2;
  const rise = ((elevationA - elevationB) * RAD) / 2;
  const h = Math.sin(rise) ** 2 + Math.cos(elevationA * RAD) * Math.cos(elevationB * RAD) * Math.sin(half) ** 2;
  return (2 * Math.asin(Math.min(1, Math.sqrt(h)))) / RAD;
}

// An angle without its jump from 360 to 0, so that a line does not cross the whole chart; null breaks the line.
export function unbroken(angles) {
  let before = null;
  return angles.map((angle) => {
    const jump = before !== null && angle !== null && Math.abs(angle - before) > 180;
    before = angle;
    return jump ? null : angle;
  });
}
