// One machine simulated by several processes, the ranks: each has a block of the array's rows, and they go
// through the cycles together. How bytes get from one to the other is not known here.
#pragma once

#include <memory>
#include <vector>

#include "cells/channels/split_link.hpp"
#include "cells/environment.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

/// What the ranks must know of each other after every cycle. Of all of them: the smallest, the largest, sums.
struct RankProgress {
    Cycle next = never;       ///< in which anybody is to be woken
    Cycle last_progress = 0;  ///< as in Counters
    std::uint64_t rays_destroyed = 0;
    std::uint64_t done = 0;  ///< cells loaded or pixels complete
    std::uint64_t hops = 0;
    std::uint64_t interrupted = 0;

    void join(const RankProgress& other);
};

/// Carries bytes between ranks. All ranks call the same members in the same order; a rank that fails ends
/// all.
class RankTransport {
  public:
    virtual ~RankTransport() = default;
    virtual int rank() const = 0;
    virtual int count() const = 0;
    struct Parcel {
        int rank = 0;  ///< the other
        const Bytes* out = nullptr;
        Bytes in;              ///< as large as it must be or larger
        std::size_t size = 0;  ///< bytes of `in` that have come
    };
    /// Hands each parcel's `out` to its rank and takes what that one has for this one.
    virtual void swap(std::vector<Parcel>& parcels) = 0;
    /// Joins the progress of all ranks.
    virtual RankProgress agree(const RankProgress& mine) = 0;
    /// What each rank has, in the order of ranks: for all of them, or for rank 0 alone (the others get
    /// nothing).
    virtual std::vector<Bytes> gather_for_all(const Bytes& mine) = 0;
    virtual std::vector<Bytes> gather(const Bytes& mine) = 0;
};

/// The rows at which bands of rows begin, and behind the last one the array's height; the bands are the
/// ranks' in turn. Several each, because what is busy moves across the array, and no two halves of it are
/// busy at the same time; all of them as high as each other, as nearly as can be. Throws
/// std::invalid_argument for fewer rows than ranks.
std::vector<int> even_bands(int ranks, int height);

/// A rank's view of the others: links to them, meetings at the end of each cycle, sums over all.
class RankExchange {
  public:
    /// `bands` as even_bands() has them: from 0, and each rank has one at least. `with_exterior`: the border
    /// of every rank's rows is joined to the exterior processors, which are rank 0's. The transport must
    /// outlive it.
    RankExchange(RankTransport& transport, std::vector<int> bands, bool with_exterior);

    int rank() const { return transport_.rank(); }
    int count() const { return transport_.count(); }
    const ArrayShare& share() const { return share_; }
    int bands() const { return int(bands_.size()) - 1; }
    int first_row(int band) const { return bands_[std::size_t(band)]; }
    int band_of(int y) const;
    /// Who has row y.
    int owner(int y) const { return band_of(y) % count(); }
    /// The links that are shared with another rank; null where there is nothing to share.
    SplitLinks* links_to(int other);

    /// The end of a cycle. Everything sent and read in it gets to its other half; clients are woken. Then,
    /// with `mine` but for its `next`, which is the scheduler's, all ranks agree.
    RankProgress meet(RankProgress mine, Environment& environment);
    /// What the last meeting agreed upon.
    const RankProgress& agreed() const { return agreed_; }

    std::vector<Bytes> gather_for_all(const Bytes& mine) { return transport_.gather_for_all(mine); }
    std::vector<Bytes> gather(const Bytes& mine) { return transport_.gather(mine); }

    /// Of the meetings so far.
    struct Statistics {
        std::uint64_t meetings = 0;
        std::uint64_t second_rounds = 0;  ///< that the first message alone did not settle
        std::uint64_t bytes = 0;          ///< sent by this rank, without what the transport adds
        double waited = 0;                ///< seconds in the transport: sending, and waiting for the slowest
    };
    const Statistics& statistics() const { return statistics_; }

  private:
    struct Peer {
        int rank;
        std::unique_ptr<SplitLinks> links;
    };
    void make_peers(bool with_exterior);
    std::vector<Band> own_bands();
    void carry(const RankProgress& mine, bool with_links);

    RankTransport& transport_;
    std::vector<int> bands_;
    ArrayShare share_;
    std::vector<Peer> peers_;
    std::vector<RankTransport::Parcel> parcels_;
    Bytes short_out_;
    RankProgress agreed_;
    Statistics statistics_;
};

/// What all ranks gave, to be read by the rows of the array or rank by rank. On a rank that was given
/// nothing, empty.
class RankReaders {
  public:
    /// `all` in the order of ranks. `ranks` must outlive it.
    RankReaders(const RankExchange& ranks, std::vector<Bytes> all) : ranks_(ranks), all_(std::move(all)) {
        for (const Bytes& bytes : all_) readers_.emplace_back(bytes);
    }
    RankReaders(const RankReaders&) = delete;
    RankReaders& operator=(const RankReaders&) = delete;
    bool empty() const { return readers_.empty(); }
    /// Of the rank that has row y.
    ByteReader& of_row(int y) { return readers_[std::size_t(ranks_.owner(y))]; }
    std::vector<ByteReader>::iterator begin() { return readers_.begin(); }
    std::vector<ByteReader>::iterator end() { return readers_.end(); }

  private:
    const RankExchange& ranks_;
    std::vector<Bytes> all_;
    std::vector<ByteReader> readers_;
};

}  // namespace raycell
