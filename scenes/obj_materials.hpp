// Materials of OBJ scenes, read from their MTL libraries (design, section 8).
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

/// The materials that an OBJ scene can name. Kd is the colour, with diffuse 1; without Kd both are the
/// default Material's. The mean of Ks is the specular share; illum 3 to 9 makes it a mirror. Ns is the shine,
/// Ni the index of refraction. With illum 4, 6, 7 or 9 the transmitted share is 1 - d, or Tr, or without both
/// the mean of Tf. Ke is the emission, which makes sources of faces (emitters.hpp). All else (Ka, textures,
/// physically based values, unknown words) is ignored with a warning, once per kind and file, except a Ka
/// that changes nothing.
///
/// Each of these gives a warning: d and Tr disagree (d holds); two materials of one name (the first holds);
/// missing colour components (they repeat the last one given); shares outside 0..1 (clamped); a negative Ns
/// (becomes 0); Ni below 0.01 (becomes 1); an unknown illum (counts as 2); lines that can't be understood
/// (ignored).
class MaterialLibraries {
  public:
    explicit MaterialLibraries(std::filesystem::path folder);

    /// Adds a library's materials to the scene. `place` is where the scene names it. Warns of a library that
    /// is missing or outside the scene's folder (also by a symbolic link), which is not opened, and of one
    /// that is no text. Such a library is no error, because the geometry does not depend on materials.
    void load(std::string_view name, const Place& place, Scene& scene, Diagnostics& diagnostics);

    /// Index into Scene::materials.
    std::optional<std::uint32_t> find(const std::string& name) const;

    /// Whether a library could not be read; then unknown materials give no further warning.
    bool incomplete() const { return incomplete_; }

  private:
    std::filesystem::path folder_;
    std::map<std::string, std::uint32_t> by_name_;
    std::set<std::filesystem::path> loaded_;
    bool incomplete_ = false;
};

}  // namespace raycell
