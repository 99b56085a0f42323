#include "testbench/common/version.hpp"

#include <systemc>

#include "built_from.hpp"

namespace raycell {

std::string version_text() {
    std::string text = RAYCELL_VERSION;
    text += ", " RAYCELL_BUILT_FROM ", GCC " __VERSION__ ", SystemC ";
    text += sc_core::sc_release();
    return text + ", " RAYCELL_BUILD_TYPE;
}

void add_version(CLI::App& app) {
    app.set_version_flag("--version", [&app] { return app.get_name() + " " + version_text(); });
}

}  // namespace raycell
