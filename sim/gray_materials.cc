#define GL_GLEXT_PROTOTYPES
#include "sim/gray_materials.h"

#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <iterator>
#include <stdexcept>
#include <vector>

#include "sim/luminance.h"

namespace nightjar::sim {
namespace {

/// Reads one face of the texture that is bound, and writes its luminance times `rgb`, 16 bits
/// a texel, to the same face of `gray`.
void convert_face(GLenum target, GLenum face, GLuint colored, GLuint gray,
                  const std::array<float, 3>& rgb) {
  glBindTexture(target, colored);
  GLint width = 0, height = 0;
  glGetTexLevelParameteriv(face, 0, GL_TEXTURE_WIDTH, &width);
  glGetTexLevelParameteriv(face, 0, GL_TEXTURE_HEIGHT, &height);
  const auto texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<float> color(3 * texels), luminances(texels);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(face, 0, GL_RGB, GL_FLOAT, color.data());
  for (std::size_t i = 0; i < texels; ++i)
    luminances[i] =
        luminance(rgb[0] * color[3 * i], rgb[1] * color[3 * i + 1], rgb[2] * color[3 * i + 2]);
  glBindTexture(target, gray);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(face, 0, GL_LUMINANCE16, width, height, 0, GL_LUMINANCE, GL_FLOAT,
               luminances.data());
}

GLuint gray_texture(int type, GLuint colored, const std::array<float, 3>& rgb) {
  const bool flat = type == mjTEXTURE_2D;
  const GLenum target = flat ? GL_TEXTURE_2D : GL_TEXTURE_CUBE_MAP;
  GLuint gray = 0;
  glGenTextures(1, &gray);
  for (GLenum side = 0; side < (flat ? 1u : 6u); ++side)
    convert_face(target, flat ? target : GL_TEXTURE_CUBE_MAP_POSITIVE_X + side, colored, gray, rgb);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateMipmap(target);
  return gray;
}

}  // namespace

void GrayMaterials::apply(mjrContext& resources, mjvScene& geoms) {
  for (int i = 0; i < geoms.ngeom; ++i) {
    mjvGeom& geom = geoms.geoms[i];
    float* rgb = geom.rgba;
    if (geom.texid < 0) {
      rgb[0] = rgb[1] = rgb[2] = luminance(rgb[0], rgb[1], rgb[2]);
      continue;
    }
    const Material material{geom.texid, {rgb[0], rgb[1], rgb[2]}};
    auto known = gray_.find(material);
    if (known == gray_.end()) {
      const int next = resources.ntexture;
      if (next == static_cast<int>(std::size(resources.texture)))
        throw std::runtime_error(
            fmt::format("more than {} textures and colours of textures", next));
      resources.textureType[next] = resources.textureType[geom.texid];
      resources.texture[next] =
          gray_texture(resources.textureType[next], resources.texture[geom.texid], material.rgb);
      ++resources.ntexture;
      known = gray_.emplace(material, next).first;
    }
    geom.texid = known->second;
    rgb[0] = rgb[1] = rgb[2] = 1;
  }
}

}  // namespace nightjar::sim
