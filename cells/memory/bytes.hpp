// Values as bytes, for other processes of the same program on computers of the same kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace raycell {

using Bytes = std::vector<std::byte>;

class ByteWriter {
  public:
    template <typename T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* at = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), at, at + sizeof(T));
    }
    template <typename T>
    void put_all(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        put(std::uint64_t(values.size()));
        const auto* at = reinterpret_cast<const std::byte*>(values.data());
        bytes_.insert(bytes_.end(), at, at + values.size() * sizeof(T));
    }
    void put(const std::string& text) { put_all(std::vector<char>(text.begin(), text.end())); }
    Bytes take() { return std::move(bytes_); }

  private:
    Bytes bytes_;
};

/// Reads in the order of writing. Throws std::logic_error past the end.
class ByteReader {
  public:
    explicit ByteReader(const Bytes& bytes) : ByteReader(bytes.data(), bytes.size()) {}
    ByteReader(const std::byte* bytes, std::size_t size) : at_(bytes), left_(size) {}
    bool at_end() const { return left_ == 0; }
    template <typename T>
    T get() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(static_cast<void*>(&value), advance(sizeof(T)), sizeof(T));
        return value;
    }
    template <typename T>
    std::vector<T> get_all() {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto count = get<std::uint64_t>();
        if (count > left_ / sizeof(T)) cut_short();
        std::vector<T> values(count);
        const std::byte* from = advance(count * sizeof(T));
        if (count > 0) std::memcpy(static_cast<void*>(values.data()), from, count * sizeof(T));
        return values;
    }
    std::string get_text() {
        const auto text = get_all<char>();
        return std::string(text.begin(), text.end());
    }

  private:
    [[noreturn]] static void cut_short() {
        throw std::logic_error("internal error: bytes from another rank are cut short");
    }
    const std::byte* advance(std::size_t size) {
        if (size > left_) cut_short();
        const std::byte* from = at_;
        at_ += size;
        left_ -= size;
        return from;
    }
    const std::byte* at_;
    std::size_t left_;
};

}  // namespace raycell
