// How the results of several ranks become one. Without ranks everything is as it is.
#pragma once

#include <string>
#include <vector>

#include "pipeline/activity.hpp"
#include "pipeline/machine_parts.hpp"

namespace raycell {

/// All ranks call the same members in the same order.
class Joined {
  public:
    explicit Joined(const MachineParts& parts) : parts_(parts), ranks_(parts.ranks) {}

    /// Of all ranks: `mine` joined with the others' by `add(T&, const T&)`.
    template <typename T, typename Add>
    T of_all(T mine, Add add) const {
        if (!ranks_) return mine;
        ByteWriter bytes;
        bytes.put(mine);
        const std::vector<Bytes> all = ranks_->gather_for_all(bytes.take());
        T sum = ByteReader(all.front()).get<T>();
        for (std::size_t rank = 1; rank < all.size(); ++rank) add(sum, ByteReader(all[rank]).get<T>());
        return sum;
    }
    std::uint64_t sum(std::uint64_t mine) const {
        return of_all(mine, [](std::uint64_t& a, std::uint64_t b) { a += b; });
    }
    /// A line of a report, and the row of cells that it is about.
    struct RowLine {
        int row;
        std::string text;
    };
    /// Sections one after the other, of all ranks, each by rows.
    std::vector<std::string> lines(std::vector<std::vector<RowLine>> sections) const;
    void join(Activity& activity) const;

    // Rank 0 has them, the others nothing.
    std::uint64_t schedule_hash() const;
    void join(Ledger& ledger) const;
    Picture picture() const;

  private:
    const MachineParts& parts_;
    RankExchange* ranks_;
};

}  // namespace raycell
