#version 450 core
centroid in vec3 place;
centroid in vec3 direction;

uniform vec3 eye;

// distance from the eye [m], the normal that faces it
layout(location = 0) out vec4 result;

void main() {
  vec3 n = normalize(direction);
  if (dot(n, eye - place) < 0.0) n = -n;
  result = vec4(distance(eye, place), n);
}
