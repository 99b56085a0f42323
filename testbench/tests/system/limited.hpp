// Programs with a limit of address space, whatever memory the computer has.
#pragma once

#include "program.hpp"

namespace raycell::system_test {

/// Runs a program with at most so many kilobytes of address space. The address sanitizer takes more than any
/// limit allows, so a test that calls this is not built with it.
inline Finished run_within_kilobytes(int kilobytes, const Workshop& workshop, const std::string& program,
                                     const Words& words) {
    const std::string limit = "ulimit -v " + std::to_string(kilobytes) + "; exec \"$0\" \"$@\"";
    return workshop.run_program("/bin/sh", joined({"-c", limit, program}, words));
}

inline Finished run_within(int megabytes, const Workshop& workshop, const std::string& program,
                           const Words& words) {
    return run_within_kilobytes(megabytes * 1000, workshop, program, words);
}

}  // namespace raycell::system_test
