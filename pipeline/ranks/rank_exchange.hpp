// One machine simulated by several processes, the ranks: each has one or more bands of the array's rows, and
// all run the same cycles together. The transport of bytes between them is left to RankTransport.
#pragma once

#include <memory>
#include <vector>

#include "cells/channels/split_link.hpp"
#include "cells/environment.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

/// What the ranks must know of each other after every cycle. join() takes the minimum of `next`, the maximum
/// of `last_progress` and `interrupted`, and the sums of the others.
struct RankProgress {
    Cycle next = never;       ///< next cycle in which a client must be woken
    Cycle last_progress = 0;  ///< as in Counters
    std::uint64_t rays_destroyed = 0;
    std::uint64_t done = 0;  ///< cells loaded or pixels complete
    std::uint64_t hops = 0;
    std::uint64_t interrupted = 0;

    void join(const RankProgress& other);
};

/// Carries bytes between ranks. All ranks must call the same members in the same order; a rank that fails
/// ends all.
class RankTransport {
  public:
    virtual ~RankTransport() = default;
    virtual int rank() const = 0;
    virtual int count() const = 0;
    struct Parcel {
        int rank = 0;  ///< the other rank
        const Bytes* out = nullptr;
        Bytes in;              ///< may be larger than `size`
        std::size_t size = 0;  ///< bytes received in `in`
    };
    /// Sends each parcel's `out` to its rank and receives that rank's bytes into `in`.
    virtual void swap(std::vector<Parcel>& parcels) = 0;
    /// Returns the joined progress of all ranks.
    virtual RankProgress agree(const RankProgress& mine) = 0;
    /// Returns the bytes of each rank, in the order of ranks: gather_for_all() to all ranks, gather() to rank
    /// 0 only (the others get an empty list).
    virtual std::vector<Bytes> gather_for_all(const Bytes& mine) = 0;
    virtual std::vector<Bytes> gather(const Bytes& mine) = 0;
};

/// The first rows of the bands, then the array's height. Bands go to the ranks in turn. Each rank has several
/// if the array is high enough, because activity moves across the array and no two halves of it are busy at
/// the same time. All bands are as nearly as possible of the same height. Throws std::invalid_argument for
/// fewer rows than ranks.
std::vector<int> even_bands(int ranks, int height);

/// A rank's view of the other ranks: links to them, meetings at the end of each cycle, sums over all ranks.
class RankExchange {
  public:
    /// `bands` as from even_bands(): it begins with 0, and each rank has at least one band. `with_exterior`:
    /// the border of every rank's rows is connected to the exterior processors, which rank 0 has. The
    /// transport must outlive it.
    RankExchange(RankTransport& transport, std::vector<int> bands, bool with_exterior);

    int rank() const { return transport_.rank(); }
    int count() const { return transport_.count(); }
    const ArrayShare& share() const { return share_; }
    int bands() const { return int(bands_.size()) - 1; }
    int first_row(int band) const { return bands_[std::size_t(band)]; }
    int band_of(int y) const;
    /// The rank that has row y.
    int owner(int y) const { return band_of(y) % count(); }
    /// The links shared with another rank; null if there are none.
    SplitLinks* links_to(int other);

    /// Ends a cycle: delivers everything sent and read in it to the other halves of the links, wakes clients,
    /// and returns the joined progress of all ranks. `mine.next` is ignored: the scheduler's is used.
    RankProgress meet(RankProgress mine, Environment& environment);
    /// The result of the last meeting.
    const RankProgress& agreed() const { return agreed_; }

    std::vector<Bytes> gather_for_all(const Bytes& mine) { return transport_.gather_for_all(mine); }
    std::vector<Bytes> gather(const Bytes& mine) { return transport_.gather(mine); }

    /// Totals over the meetings so far.
    struct Statistics {
        std::uint64_t meetings = 0;
        std::uint64_t second_rounds = 0;  ///< meetings that needed a second exchange
        std::uint64_t bytes = 0;          ///< sent by this rank, without the transport's overhead
        double waited = 0;  ///< seconds in the transport: sending and waiting for the slowest rank
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

/// Readers of the bytes gathered from all ranks, by row of the array or rank by rank. Empty on a rank that
/// got nothing.
class RankReaders {
  public:
    /// `all` in the order of ranks. `ranks` must outlive it.
    RankReaders(const RankExchange& ranks, std::vector<Bytes> all) : ranks_(ranks), all_(std::move(all)) {
        for (const Bytes& bytes : all_) readers_.emplace_back(bytes);
    }
    RankReaders(const RankReaders&) = delete;
    RankReaders& operator=(const RankReaders&) = delete;
    bool empty() const { return readers_.empty(); }
    /// The reader of the rank that has row y.
    ByteReader& of_row(int y) { return readers_[std::size_t(ranks_.owner(y))]; }
    std::vector<ByteReader>::iterator begin() { return readers_.begin(); }
    std::vector<ByteReader>::iterator end() { return readers_.end(); }

  private:
    const RankExchange& ranks_;
    std::vector<Bytes> all_;
    std::vector<ByteReader> readers_;
};

}  // namespace raycell
