// Reuses objects: no allocation per message once a run is warm.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace raycell {

/// Hands out objects that stay where they are. Not for several threads.
template <typename T>
class Pool {
  public:
    T* take() {
        if (free_.empty()) return &all_.emplace_back();
        T* object = free_.back();
        free_.pop_back();
        *object = T();
        return object;
    }
    void give_back(T* object) { free_.push_back(object); }
    std::size_t in_use() const { return all_.size() - free_.size(); }

  private:
    std::deque<T> all_;
    std::vector<T*> free_;
};

}  // namespace raycell
