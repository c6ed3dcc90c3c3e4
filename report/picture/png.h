// Pictures as PNG bytes. Equal pixels give equal bytes.
#pragma once

#include <string>

#include "core/image.h"
#include "renderer/scene_view.h"

namespace understudy::report {

/// Throws std::logic_error when the pixels do not fill the size.
std::string encode_png(const Image& grey);
std::string encode_png(const renderer::Picture& picture);

/// Base64 of RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace understudy::report
