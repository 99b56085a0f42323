// Materials of OBJ scenes, from their MTL libraries (design, section 8).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"
#include "scenes/outline.hpp"

namespace raycell {

/// The materials that an OBJ scene can name. Kd becomes the colour (with diffuse 1; without Kd the default
/// Material's), the mean of Ks the specular share, mirrored where illum is 3 to 9; Ns the shine, Ni the index
/// of refraction; 1 - d, or Tr, the transmitted share where illum is 4, 6, 7 or 9, and the mean of Tf where
/// such a material has neither. What else there is (Ka, Ke, textures, physically based values, unknown words)
/// is left out; a warning names it, once per kind and file, but for a black Ke and a Ka that changes nothing.
///
/// Each with a warning: d holds against Tr; the first of two materials of one name; missing components repeat
/// the last one given; shares are brought into 0..1, a negative Ns to 0; Ni below 0.01 becomes 1; an unknown
/// illum counts as 2; lines that can't be understood are left out.
class MaterialLibraries {
  public:
    explicit MaterialLibraries(std::filesystem::path folder);

    /// Adds a library's materials to the scene. A library that is missing, or outside the scene's folder
    /// (also by a symbolic link), is not opened; a warning says so. `place` is where the scene names it.
    /// The same of a library that is no text: no fault of a material makes the geometry another one.
    void load(std::string_view name, const Place& place, Scene& scene, Diagnostics& diagnostics);

    /// Index into Scene::materials.
    std::optional<std::uint32_t> find(const std::string& name) const;

    /// A library could not be read; then unknown materials are no news.
    bool incomplete() const { return incomplete_; }

  private:
    std::filesystem::path folder_;
    std::map<std::string, std::uint32_t> by_name_;
    std::set<std::filesystem::path> loaded_;
    bool incomplete_ = false;
};

}  // namespace raycell
