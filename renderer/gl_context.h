// Private to this room: an off-screen OpenGL 4.5 core context (OSMesa), its functions and its objects.
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::renderer {

// libepoxy and GLEW need GLX or EGL; OSMesa hands out its own functions.
// clang-format off
#define UNDERSTUDY_GL_FUNCTIONS(X) \
  X(ActiveTexture) X(AttachShader) X(BindBuffer) X(BindFramebuffer) X(BindRenderbuffer) X(BindTexture) \
  X(BindVertexArray) X(BlitFramebuffer) X(BufferData) X(CheckFramebufferStatus) X(Clear) X(ClearBufferfv) \
  X(CompileShader) X(CreateProgram) X(CreateShader) X(DeleteBuffers) X(DeleteFramebuffers) \
  X(DeleteProgram) X(DeleteRenderbuffers) X(DeleteShader) X(DeleteTextures) X(DeleteVertexArrays) \
  X(ColorMask) X(DepthFunc) X(Disable) X(DrawArrays) X(DrawElements) X(Enable) X(EnableVertexAttribArray) X(Finish) \
  X(FramebufferRenderbuffer) X(FramebufferTexture2D) X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers) \
  X(GenTextures) X(GenVertexArrays) X(GetError) X(GetProgramInfoLog) X(GetProgramiv) X(GetShaderInfoLog) \
  X(GetShaderiv) X(GetString) X(GetUniformLocation) X(LinkProgram) X(PixelStorei) X(PolygonOffset) \
  X(ReadPixels) X(RenderbufferStorageMultisample) X(Scissor) X(ShaderSource) X(TexImage2D) \
  X(TexImage2DMultisample) X(TexParameteri) \
  X(Uniform1f) X(Uniform1i) X(Uniform2f) X(Uniform2i) X(Uniform3f) X(Uniform3fv) X(Uniform4f) \
  X(UniformMatrix3fv) X(UniformMatrix4fv) X(UseProgram) X(VertexAttribPointer) X(Viewport)
// clang-format on

struct GlFunctions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a member's name takes none
#define UNDERSTUDY_GL_MEMBER(name) decltype(&::gl##name) name = nullptr;
  UNDERSTUDY_GL_FUNCTIONS(UNDERSTUDY_GL_MEMBER)
#undef UNDERSTUDY_GL_MEMBER
};

/// Throws MachineError when OSMesa cannot give a 4.5 core context.
class GlContext {
 public:
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Before any drawing: OSMesa's current context belongs to the calling thread.
  void make_current();
  /// Throws MachineError naming `where` when OpenGL has recorded an error.
  void check(const char* where) const;

  const GlFunctions& gl() const { return gl_; }
  static int made();  ///< contexts of this process, so far

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  GlFunctions gl_;
};

class GlProgram {
 public:
  GlProgram(const GlFunctions& gl, std::string_view name, const std::string& vertex_source,
            const std::string& fragment_source);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const { gl_.UseProgram(id_); }
  /// A uniform that the shader does not know is our own mistake and throws std::logic_error.
  GLint uniform(const char* name) const;

 private:
  const GlFunctions& gl_;
  GLuint id_ = 0;
};

/// Colour and depth textures of one size.
class GlTarget {
 public:
  GlTarget(const GlFunctions& gl, GLenum colour_format, int width, int height);
  ~GlTarget();
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;

  void bind() const;
  GLuint colour() const { return textures_[0]; }
  GLuint depth() const { return textures_[1]; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  const GlFunctions& gl_;
  GLuint framebuffer_ = 0;
  GLuint textures_[2] = {0, 0};
  int width_, height_;
};

/// 8-bit colour and depth with several samples in a pixel; read through resolve().
class GlSmoothTarget {
 public:
  GlSmoothTarget(const GlFunctions& gl, int width, int height);
  ~GlSmoothTarget();
  GlSmoothTarget(const GlSmoothTarget&) = delete;
  GlSmoothTarget& operator=(const GlSmoothTarget&) = delete;

  void bind() const;
  int samples() const;
  /// A texture of several samples.
  GLuint depth() const { return depth_; }
  /// RGBA, bottom row first.
  std::vector<unsigned char> resolve() const;

 private:
  const GlFunctions& gl_;
  GLuint framebuffers_[2] = {0, 0};  // drawn, resolved
  GLuint buffers_[2] = {0, 0};       // drawn colour, resolved colour
  GLuint depth_ = 0;                 // drawn
  int width_, height_;
};

/// Which vertices make triangles, three each.
class GlTriangles {
 public:
  explicit GlTriangles(const GlFunctions& gl);
  ~GlTriangles();
  GlTriangles(const GlTriangles&) = delete;
  GlTriangles& operator=(const GlTriangles&) = delete;

  void fill(const std::vector<std::uint32_t>& corners);
  /// Of the vertex array that is bound.
  void draw() const;

 private:
  const GlFunctions& gl_;
  GLuint buffer_ = 0;
  int count_ = 0;  // corners
};

/// Vertices of float attributes, refilled for every draw. `layout`: number of floats of each attribute.
class GlVertices {
 public:
  GlVertices(const GlFunctions& gl, const std::vector<int>& layout);
  ~GlVertices();
  GlVertices(const GlVertices&) = delete;
  GlVertices& operator=(const GlVertices&) = delete;

  void fill(const std::vector<float>& values);
  void draw(GLenum primitive) const;
  void draw(const GlTriangles& triangles) const;

 private:
  const GlFunctions& gl_;
  GLuint array_ = 0;
  GLuint buffer_ = 0;
  int stride_ = 0;  // floats
  int count_ = 0;   // vertices
};

}  // namespace understudy::renderer
