// Reuses objects, so that a run that is warm allocates nothing per message.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "cells/memory/stable_array.hpp"

namespace raycell {

/// Hands out objects with stable addresses. Not thread-safe.
template <typename T>
class Pool {
  public:
    T* take() {
        if (free_.empty()) return make();
        T* object = free_.back();
        free_.pop_back();
        *object = T();
        return object;
    }
    void give_back(T* object) { free_.push_back(object); }
    std::size_t in_use() const { return made_ - free_.size(); }

  private:
    /// Each object begins at a cache line, so that a prefetch brings no other object's bytes.
    struct alignas(64) Place {
        T object;
    };
    static constexpr std::size_t block = StableArray<Place>::page / sizeof(Place);  // in objects
    T* make() {
        if (made_ % block == 0) {
            blocks_.push_back(std::make_unique<StableArray<Place>>());
            blocks_.back()->reserve(block);
        }
        ++made_;
        return &blocks_.back()->emplace_back().object;
    }

    std::vector<std::unique_ptr<StableArray<Place>>> blocks_;
    std::size_t made_ = 0;
    std::vector<T*> free_;
};

}  // namespace raycell
