#include "clients/view/render/off_screen.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

namespace footing::render {
namespace {

Error NoContext(const std::string& what) {
  return Failure(what + " (EGL error " + std::to_string(eglGetError()) +
                 "): drawing without a display needs Mesa; try: apt install libegl1 "
                 "libgl1-mesa-dri");
}

}  // namespace

Result<OffScreen> OffScreen::Create() {
  EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    return NoContext("no EGL display without a screen");
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return NoContext("EGL has no OpenGL");
  const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                     EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
    return NoContext("EGL has no fitting configuration");
  }
  const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                      3,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      3,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  if (context == EGL_NO_CONTEXT) return NoContext("no OpenGL 3.3 context");
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    eglDestroyContext(display, context);
    return NoContext("the OpenGL context cannot be used");
  }
  return OffScreen(display, context);
}

OffScreen::~OffScreen() {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

}  // namespace footing::render
