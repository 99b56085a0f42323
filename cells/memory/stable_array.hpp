// An array of many large objects with stable addresses: cells and links.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <stdexcept>
#include <utility>

namespace raycell {

/// Room for a number of objects known in advance, which are made one by one. The memory is aligned for huge
/// pages and asks the system for them: neighbouring cells are far apart in memory, and page-table look-ups
/// would cost a tenth of a run. Unused room is never touched.
template <typename T>
class StableArray {
  public:
    StableArray() = default;
    StableArray(const StableArray&) = delete;
    StableArray& operator=(const StableArray&) = delete;
    ~StableArray() {
        while (size_ > 0) objects_[--size_].~T();
        if (objects_) ::operator delete(objects_, std::align_val_t(page));
    }

    /// To be called once, before the first object. Throws std::bad_alloc; std::logic_error on a second call.
    void reserve(std::size_t capacity) {
        if (objects_) throw std::logic_error("a stable array's room is given out once");
        const std::size_t bytes = (capacity * sizeof(T) + page - 1) / page * page;
        objects_ = static_cast<T*>(::operator new(bytes, std::align_val_t(page)));
        capacity_ = capacity;
        madvise(objects_, bytes, MADV_HUGEPAGE);  // only a hint: it may fail
    }
    /// Makes an object at the end. Throws std::length_error when the room is used up.
    template <typename... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        if (size_ == capacity_) throw std::length_error("a stable array is full");
        T* object = new (objects_ + size_) T(std::forward<Arguments>(arguments)...);
        ++size_;
        return *object;
    }

    std::size_t size() const { return size_; }
    T& operator[](std::size_t index) { return objects_[index]; }
    const T& operator[](std::size_t index) const { return objects_[index]; }
    T* begin() { return objects_; }
    T* end() { return objects_ + size_; }
    const T* begin() const { return objects_; }
    const T* end() const { return objects_ + size_; }

    static constexpr std::size_t page = std::size_t(2) << 20;  ///< bytes of a huge page

  private:
    T* objects_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace raycell
