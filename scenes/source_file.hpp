// Light sources from a file of their own: points and others.
#pragma once

#include <filesystem>
#include <vector>

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// What a file of sources says.
struct SourceFile {
    bool add = false;  ///< to those of the scene, instead of replacing them
    std::vector<LightSource> sources;
};

/// Reads a TOML file of sources (docs/use/sources.md). Throws InputError naming file and line: for what is no
/// TOML, an unknown key or kind, a number that is missing or out of range, no source or more than
/// max_sources.
SourceFile read_sources(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
SourceFile read_sources_text(std::string_view text, const std::string& name);

/// Gives a scene the sources of a file.
void take_sources(Scene& scene, SourceFile file);

}  // namespace raycell
