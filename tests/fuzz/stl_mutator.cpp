// For libFuzzer: keeps the size of a binary STL in step with the number of triangles that it announces, which
// bytes changed at random almost never do.
#include <algorithm>
#include <cstdint>
#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  const bool text = size >= 5 && std::memcmp(data, "solid", 5) == 0;
  const bool whole = !text && size >= kHeader && seed % 8 != 0;
  std::size_t length = LLVMFuzzerMutate(data, size, max_size);
  if (!whole || length < kHeader) return length;
  if (std::memcmp(data, "solid", 5) == 0) data[0] = ' ';
  const auto triangles = static_cast<std::uint32_t>((length - kHeader) / kTriangle);
  std::memcpy(data + kHeader - 4, &triangles, sizeof triangles);
  return kHeader + kTriangle * triangles;
}
