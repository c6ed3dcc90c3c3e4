#version 450 core
// The farthest of a pixel's samples: what lies behind it is seen nowhere in the pixel.
uniform sampler2DMS depth;
uniform int samples;
layout(location = 0) out vec4 result;
void main() {
  float farthest = 0.0;
  for (int i = 0; i < samples; ++i) farthest = max(farthest, texelFetch(depth, ivec2(gl_FragCoord.xy), i).r);
  result = vec4(farthest, 0.0, 0.0, 1.0);
}
