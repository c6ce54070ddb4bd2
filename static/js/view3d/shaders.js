// The four small programs of the WebGL painter. Colours come with alpha and leave multiplied by it.

const HEAD = "#version 300 es\nprecision highp float;\n";

// A body is a unit mesh under `model`, whose columns are square to each other: that gives its normals.
const SOLID = `
in vec3 place, normal;
uniform mat4 camera, model;
out vec3 facing, spot, side;
void main() {
  vec3 size = vec3(dot(model[0].xyz, model[0].xyz), dot(model[1].xyz, model[1].xyz), dot(model[2].xyz, model[2].xyz));
  facing = mat3(model) * (normal / size);
  spot = place;
  side = normal;
  gl_Position = camera * model * vec4(place, 1.0);
}`;
const LIT = `
in vec3 facing, spot, side;
uniform vec3 light;
uniform vec4 colour, front, rib;
uniform vec2 cells;
out vec4 seen;
void main() {
  vec4 paint = colour;
  if (cells.x > 0.0 && side.z > 0.5) {
    vec2 at = (spot.xy + 0.5) * cells;
    vec2 far = abs(fract(at - 0.5) - 0.5) / max(fwidth(at), vec2(1e-4));
    paint = mix(front, rib, 0.7 * (1.0 - min(min(far.x, far.y) / 1.2, 1.0)));
  }
  float shade = 0.66 + 0.34 * max(dot(normalize(facing), light), 0.0);
  seen = vec4(paint.rgb * shade * paint.a, paint.a);
}`;

// The same bodies, thrown along the sun's rays onto the ground.
const THROWN = `
in vec3 place;
uniform mat4 camera, model;
uniform vec3 rays;
out vec2 ground;
void main() {
  vec3 world = (model * vec4(place, 1.0)).xyz;
  vec2 at = world.xy - rays.xy * (world.z / rays.z);
  ground = at;
  gl_Position = camera * vec4(at, 0.0015, 1.0);
}`;
const SHADE = `
in vec2 ground;
uniform vec4 colour;
out vec4 seen;
void main() {
  if (dot(ground, ground) > 1.0) discard;
  seen = vec4(colour.rgb * colour.a, colour.a);
}`;

// Lines come as ready triangles in clip space, with their length in pixels for the dashes.
const DRAWN = `
in vec4 corner, paint;
in vec3 along;
out vec4 tone;
out vec3 run;
void main() { tone = paint; run = along; gl_Position = corner; }`;
const DASHED = `
in vec4 tone;
in vec3 run;
out vec4 seen;
void main() {
  if (run.z > 0.0 && mod(run.x, run.y + run.z) > run.y) discard;
  seen = vec4(tone.rgb * tone.a, tone.a);
}`;

const STUCK = `
in vec4 corner;
in vec2 where;
out vec2 on;
void main() { on = where; gl_Position = corner; }`;
const SPRITE = `
in vec2 on;
uniform sampler2D sheet;
out vec4 seen;
void main() { seen = texture(sheet, on); if (seen.a < 0.02) discard; }`;

export const SOURCES = {
  solid: [SOLID, LIT], shadow: [THROWN, SHADE], line: [DRAWN, DASHED], mark: [STUCK, SPRITE],
};

export function programs(gl) {
  return Object.fromEntries(Object.entries(SOURCES).map(([name, sources]) => [name, program(gl, ...sources)]));
}

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, HEAD + source.trim());
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  ["place", "normal"].forEach((name, index) => gl.bindAttribLocation(made, index, name));
  ["corner", "paint", "along"].forEach((name, index) => gl.bindAttribLocation(made, index, name));
  gl.bindAttribLocation(made, 1, "where");
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(`A shader does not link: ${gl.getProgramInfoLog(made)}`);
  const count = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS);
  const uniforms = Array.from({ length: count }, (_, index) => gl.getActiveUniform(made, index).name);
  return { made, at: Object.fromEntries(uniforms.map((name) => [name, gl.getUniformLocation(made, name)])) };
}
