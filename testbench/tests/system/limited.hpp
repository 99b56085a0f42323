// Programs with a limit of address space, whatever memory the computer has.
#pragma once

#include "program.hpp"

namespace raycell::system_test {

/// Not under the sanitizer, which takes address space beyond every limit.
#define SKIP_WITHOUT_LIMITS() \
    if (sanitized)            \
    GTEST_SKIP() << "the sanitizer's shadow memory takes more address space than any limit allows"

/// Runs a program with at most so many megabytes of address space.
inline Finished run_within(int megabytes, const Workshop& workshop, const std::string& program,
                           const Words& words) {
    const std::string limit = "ulimit -v " + std::to_string(megabytes * 1000) + "; exec \"$0\" \"$@\"";
    return workshop.run_program("/bin/sh", joined({"-c", limit, program}, words));
}

}  // namespace raycell::system_test
