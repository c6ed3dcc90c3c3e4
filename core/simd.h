// Which of the processor's instructions for several numbers at a time are used. Results do not depend on it
// (docs/determinism.md); UNDERSTUDY_SIMD chooses less than the processor has, to show that.
#pragma once

namespace understudy {

enum class Simd { scalar, sse2, avx2 };

/// What UNDERSTUDY_SIMD says, otherwise the most that the processor has. sse2 stands for two numbers at a
/// time on any processor. Throws InputError for a word that is none, and for instructions that the processor
/// lacks.
Simd simd();

const char* word(Simd choice);

}  // namespace understudy
