#version 450 core
layout(location = 0) in vec2 corner;  // of one triangle that covers the target
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
