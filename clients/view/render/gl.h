#pragma once

// OpenGL 3.3 core. libOpenGL exports the functions, so no loader is needed.
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
