#include "renderer/drawing_threads.h"

#include <cstdlib>

namespace understudy::renderer {

// llvmpipe reads it when it makes its first context.
void draw_on_calling_thread() { ::setenv("LP_NUM_THREADS", "0", 0); }

}  // namespace understudy::renderer
