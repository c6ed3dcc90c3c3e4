#version 450 core
in float along;
layout(location = 0) out vec4 result;
void main() { result = vec4(along, 0.0, 0.0, 0.0); }
