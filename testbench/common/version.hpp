// Which program this is.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace raycell {

/// "0.2.0, commit 1a2b3c4d, GCC 12.2.0, SystemC 2.3.4, Release": what --version prints and reports keep.
std::string version_text();

/// Adds --version.
void add_version(CLI::App& app);

}  // namespace raycell
