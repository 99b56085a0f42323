// Joins the results of several ranks. Without ranks the results stay as they are.
#pragma once

#include <string>
#include <vector>

#include "pipeline/activity.hpp"
#include "pipeline/machine_parts.hpp"

namespace raycell {

/// All ranks must call the same members in the same order.
class Joined {
  public:
    explicit Joined(const MachineParts& parts) : parts_(parts), ranks_(parts.ranks) {}

    /// Joins `mine` with the values of the other ranks by `add(T&, const T&)`; all ranks get the result.
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
    /// A line of a report and its row of cells.
    struct RowLine {
        int row;
        std::string text;
    };
    /// The lines of all ranks, section by section; within a section sorted by row.
    std::vector<std::string> lines(std::vector<std::vector<RowLine>> sections) const;
    void join(Activity& activity) const;

    // Only rank 0 gets these results; the other ranks get empty ones.
    std::uint64_t schedule_hash() const;
    void join(Ledger& ledger) const;
    Picture picture() const;

  private:
    const MachineParts& parts_;
    RankExchange* ranks_;
};

}  // namespace raycell
