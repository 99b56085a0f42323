// Asking for memory ahead.
#pragma once

namespace raycell {

/// Asks for the line of memory at an address, which may be any. The empty piece of assembly keeps compilers
/// from taking what only asks for memory for something that does nothing, and leaving out calls of it.
inline void fetch_line(const void* address) {
    __builtin_prefetch(address, 1);
    asm volatile("");
}

}  // namespace raycell
