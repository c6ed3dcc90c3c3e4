// How many threads this process may compute on.
#pragma once

namespace understudy {

/// From now on at most `most` (1 or more) threads compute at once, the calling one among them. To be called
/// before anything computes.
void limit_threads(int most);

/// What limit_threads() was last called with; without a call, more than any processor has.
int thread_limit();

}  // namespace understudy
