#include "core/simd.h"

#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy {
namespace {

bool has_avx2() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace

Simd simd() {
  const char* set = std::getenv("UNDERSTUDY_SIMD");
  if (!set || !*set) return has_avx2() ? Simd::avx2 : Simd::sse2;
  for (const Simd choice : {Simd::scalar, Simd::sse2, Simd::avx2}) {
    if (set != std::string(word(choice))) continue;
    if (choice == Simd::avx2 && !has_avx2())
      throw InputError("UNDERSTUDY_SIMD=avx2: this processor has no AVX2; unset it, or say sse2 or scalar");
    return choice;
  }
  throw InputError(fmt::format("UNDERSTUDY_SIMD={}: say scalar, sse2 or avx2", set));
}

const char* word(Simd choice) {
  switch (choice) {
    case Simd::scalar:
      return "scalar";
    case Simd::sse2:
      return "sse2";
    case Simd::avx2:
      break;
  }
  return "avx2";
}

}  // namespace understudy
