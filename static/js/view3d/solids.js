// The two bodies everything is made of: a cube and a tube along z, each of size one about the origin.

const SIDES = 18;

// A face is a flat polygon, seen from outside anticlockwise, with a normal at each corner.
const flat = (points, normal) => ({ points, normals: points.map(() => normal), normal });

function cube() {
  const faces = [];
  for (const axis of [0, 1, 2]) {
    for (const sign of [-1, 1]) {
      const [u, v] = sign > 0 ? [(axis + 1) % 3, (axis + 2) % 3] : [(axis + 2) % 3, (axis + 1) % 3];
      const corner = (a, b) => { const point = [0, 0, 0]; point[axis] = sign / 2; point[u] = a / 2; point[v] = b / 2; return point; };
      const normal = [0, 0, 0];
      normal[axis] = sign;
      faces.push(flat([corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)], normal));
    }
  }
  return faces;
}

function tube() {
  const rim = (index, z) => { const turn = (index * 2 * Math.PI) / SIDES; return [Math.cos(turn) / 2, Math.sin(turn) / 2, z]; };
  const outwards = (index) => { const [x, y] = rim(index, 0); return [2 * x, 2 * y, 0]; };
  const around = Array.from({ length: SIDES }, (_, index) => index);
  const sides = around.map((index) => ({
    points: [rim(index, -0.5), rim(index + 1, -0.5), rim(index + 1, 0.5), rim(index, 0.5)],
    normals: [outwards(index), outwards(index + 1), outwards(index + 1), outwards(index)],
    normal: outwards(index + 0.5),
  }));
  const lid = (z) => flat((z > 0 ? around : [...around].reverse()).map((index) => rim(index, z)), [0, 0, 2 * z]);
  return [...sides, lid(-0.5), lid(0.5)];
}

export const MESHES = { cube: cube(), tube: tube() };
