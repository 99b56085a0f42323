// Prefetching of cache lines.
#pragma once

namespace raycell {

/// Prefetches the cache line at an address; any address is allowed. The empty assembly statement keeps
/// compilers from removing functions that only prefetch.
inline void fetch_line(const void* address) {
    __builtin_prefetch(address, 1);
    asm volatile("");
}

}  // namespace raycell
