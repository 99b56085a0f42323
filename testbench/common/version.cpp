#include "testbench/common/version.hpp"

#include "built_from.hpp"

namespace raycell {

std::string version_text() {
    std::string text = RAYCELL_VERSION;
    return text + ", " RAYCELL_BUILT_FROM ", GCC " __VERSION__ ", SystemC " RAYCELL_SYSTEMC
                  ", " RAYCELL_BUILD_TYPE;
}

void add_version(CLI::App& app) {
    app.set_version_flag("--version", [&app] { return app.get_name() + " " + version_text(); });
}

}  // namespace raycell
