// How many threads this process may compute on.
#pragma once

namespace understudy {

/// From now on a call of in_parallel() (core/parallel.h) takes at most `most` (1 or more) threads, the
/// calling one among them; with 1 no part of this process computes on a thread of its own. To be called
/// before anything computes.
void limit_threads(int most);

/// What limit_threads() was last called with; without a call, more than any processor has.
int thread_limit();

}  // namespace understudy
