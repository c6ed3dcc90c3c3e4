// The threads on which Mesa's rasteriser draws.
#pragma once

namespace understudy::renderer {

/// No threads of Mesa's own: pictures are drawn on the thread that asks. To be called before the first
/// context is made. LP_NUM_THREADS in the environment is stronger. Pictures do not depend on it.
void draw_on_calling_thread();

}  // namespace understudy::renderer
