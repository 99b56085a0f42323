// What a misspelt option may have meant.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace raycell {

/// The option of `app` that is nearest to the word "--NAME" or "--NAME=VALUE", if it is no more than two
/// letters (one, for short names) away or begins like it; else empty.
std::string nearest_option(const CLI::App& app, const std::string& word);

}  // namespace raycell
