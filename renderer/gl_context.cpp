#include "renderer/gl_context.h"

#include <GL/osmesa.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"

namespace understudy::renderer {
namespace {

// OSMesa makes its screen on first use, without a lock of its own.
std::mutex& context_mutex() {
  static std::mutex mutex;
  return mutex;
}

std::atomic<int> contexts_made = 0;

template <typename Function>
void load(Function& function, const char* name) {
  function = reinterpret_cast<Function>(OSMesaGetProcAddress(name));
  if (!function) throw MachineError(std::string("OSMesa does not provide ") + name);
}

/// Mesa dereferences a null pointer where it does not know the driver.
void check_driver() {
  const char* asked = std::getenv("GALLIUM_DRIVER");
  const std::string_view word = asked ? asked : "";
  if (!word.empty() && word != "llvmpipe" && word != "softpipe")
    throw MachineError("GALLIUM_DRIVER is '" + std::string(word) + "', not llvmpipe or softpipe: unset it");
}

}  // namespace

struct GlContext::Handle {
  OSMesaContext context = nullptr;
  // Drawing goes to framebuffer objects; OSMesa still wants memory of its own to be current.
  std::array<unsigned char, 4 * 4 * 4> pixels{};
};

int GlContext::made() { return contexts_made; }

GlContext::GlContext() : handle_(std::make_unique<Handle>()) {
  ++contexts_made;
  check_driver();
  const std::lock_guard lock(context_mutex());
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  handle_->context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!handle_->context) throw MachineError("OSMesa cannot make an OpenGL 4.5 core context");
  make_current();
#define UNDERSTUDY_GL_LOAD(name) load(gl_.name, "gl" #name);
  UNDERSTUDY_GL_FUNCTIONS(UNDERSTUDY_GL_LOAD)
#undef UNDERSTUDY_GL_LOAD
}

GlContext::~GlContext() {
  const std::lock_guard lock(context_mutex());
  if (OSMesaGetCurrentContext() == handle_->context)
    OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  OSMesaDestroyContext(handle_->context);
}

void GlContext::make_current() {
  if (OSMesaGetCurrentContext() == handle_->context) return;
  if (!OSMesaMakeCurrent(handle_->context, handle_->pixels.data(), GL_UNSIGNED_BYTE, 4, 4)) {
    throw MachineError("OSMesa cannot make its context current");
  }
}

void GlContext::check(const char* where) const {
  const GLenum error = gl_.GetError();
  if (error != GL_NO_ERROR) {
    throw MachineError("OpenGL error " + std::to_string(error) + " in " + where);
  }
}

namespace {

GLuint compile(const GlFunctions& gl, GLenum kind, std::string_view name, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::array<char, 2000> log{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  throw MachineError("shader " + std::string(name) + " does not compile: " + log.data());
}

}  // namespace

GlProgram::GlProgram(const GlFunctions& gl, std::string_view name, const std::string& vertex_source,
                     const std::string& fragment_source)
    : gl_(gl) {
  const GLuint vertex = compile(gl, GL_VERTEX_SHADER, name, vertex_source);
  const GLuint fragment = compile(gl, GL_FRAGMENT_SHADER, name, fragment_source);
  id_ = gl.CreateProgram();
  gl.AttachShader(id_, vertex);
  gl.AttachShader(id_, fragment);
  gl.LinkProgram(id_);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  GLint good = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good) return;
  std::array<char, 2000> log{};
  gl.GetProgramInfoLog(id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteProgram(id_);
  throw MachineError("shader " + std::string(name) + " does not link: " + log.data());
}

GlProgram::~GlProgram() { gl_.DeleteProgram(id_); }

GLint GlProgram::uniform(const char* name) const {
  const GLint location = gl_.GetUniformLocation(id_, name);
  if (location < 0) throw std::logic_error(std::string("no shader uniform ") + name);
  return location;
}

GlTarget::GlTarget(const GlFunctions& gl, GLenum colour_format, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  gl.GenFramebuffers(1, &framebuffer_);
  gl.GenTextures(2, textures_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    gl.BindTexture(GL_TEXTURE_2D, textures_[i]);
    const GLenum inside = i == 0 ? colour_format : GL_DEPTH_COMPONENT32F;
    const GLenum outside = i == 0 ? GL_RGBA : GL_DEPTH_COMPONENT;
    gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(inside), width, height, 0, outside, GL_FLOAT, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, attachments[i], GL_TEXTURE_2D, textures_[i], 0);
  }
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw MachineError("OpenGL cannot make a framebuffer of " + std::to_string(width) + " x " +
                       std::to_string(height) + " pixels");
  }
}

GlTarget::~GlTarget() {
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteTextures(2, textures_);
}

void GlTarget::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
}

namespace {
constexpr int kSamples = 4;  // all that llvmpipe offers
}

GlSmoothTarget::GlSmoothTarget(const GlFunctions& gl, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  gl.GenFramebuffers(2, framebuffers_);
  gl.GenRenderbuffers(2, buffers_);
  gl.GenTextures(1, &depth_);
  const auto attach = [&](int framebuffer, int buffer, int samples, GLenum format, GLenum place) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_[framebuffer]);
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffers_[buffer]);
    gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffers_[buffer]);
  };
  attach(0, 0, kSamples, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, depth_);
  gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, kSamples, GL_DEPTH_COMPONENT32F, width, height,
                           GL_TRUE);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D_MULTISAMPLE, depth_, 0);
  attach(1, 1, 0, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  for (const GLuint framebuffer : framebuffers_) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw MachineError("OpenGL cannot make a smooth framebuffer of " + std::to_string(width) + " x " +
                         std::to_string(height) + " pixels");
    }
  }
}

GlSmoothTarget::~GlSmoothTarget() {
  gl_.DeleteFramebuffers(2, framebuffers_);
  gl_.DeleteRenderbuffers(2, buffers_);
  gl_.DeleteTextures(1, &depth_);
}

int GlSmoothTarget::samples() const { return kSamples; }

void GlSmoothTarget::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_[0]);
  gl_.Viewport(0, 0, width_, height_);
}

std::vector<unsigned char> GlSmoothTarget::resolve() const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[0]);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[1]);
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[1]);
  std::vector<unsigned char> pixels(4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  return pixels;
}

GlTriangles::GlTriangles(const GlFunctions& gl) : gl_(gl) { gl.GenBuffers(1, &buffer_); }

GlTriangles::~GlTriangles() { gl_.DeleteBuffers(1, &buffer_); }

void GlTriangles::fill(const std::vector<std::uint32_t>& corners) {
  // By this name the buffer belongs to no vertex array.
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(std::uint32_t)),
                 corners.data(), GL_STREAM_DRAW);
  count_ = static_cast<int>(corners.size());
}

void GlTriangles::draw() const {
  // llvmpipe sorts triangles into tiles, half a kilobyte each, before it draws any: by parts it needs less
  // memory.
  constexpr int kPart = 3 * 16'384;  // corners
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer_);
  for (int first = 0; first < count_; first += kPart) {
    if (first > 0) gl_.Finish();
    const std::size_t bytes = static_cast<std::size_t>(first) * sizeof(std::uint32_t);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes an offset there
    const auto* offset = reinterpret_cast<const void*>(bytes);
    gl_.DrawElements(GL_TRIANGLES, std::min(kPart, count_ - first), GL_UNSIGNED_INT, offset);
  }
}

GlVertices::GlVertices(const GlFunctions& gl, const std::vector<int>& layout) : gl_(gl) {
  gl.GenVertexArrays(1, &array_);
  gl.GenBuffers(1, &buffer_);
  gl.BindVertexArray(array_);
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  for (const int floats : layout) stride_ += floats;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const auto index = static_cast<GLuint>(i);
    gl.VertexAttribPointer(index, layout[i], GL_FLOAT, GL_FALSE,
                           stride_ * static_cast<GLsizei>(sizeof(float)),
                           // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes an offset there
                           reinterpret_cast<const void*>(offset * sizeof(float)));
    gl.EnableVertexAttribArray(index);
    offset += static_cast<std::size_t>(layout[i]);
  }
}

GlVertices::~GlVertices() {
  gl_.DeleteBuffers(1, &buffer_);
  gl_.DeleteVertexArrays(1, &array_);
}

void GlVertices::fill(const std::vector<float>& values) {
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data(),
                 GL_STREAM_DRAW);
  count_ = static_cast<int>(values.size()) / stride_;
}

void GlVertices::draw(GLenum primitive) const {
  gl_.BindVertexArray(array_);
  gl_.DrawArrays(primitive, 0, count_);
}

void GlVertices::draw(const GlTriangles& triangles) const {
  gl_.BindVertexArray(array_);
  triangles.draw();
}

}  // namespace understudy::renderer
