#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
uniform mat4 clip;
void main() { gl_Position = clip * vec4(position, 1.0); }
