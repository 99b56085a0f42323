// Links between cells of different ranks: each of the two ranks has a link object of its own, a half link.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "cells/channels/link.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

/// All half links that a rank shares with one other rank.
///
/// The source's half keeps its messages until the far end has read them, so its room, wires, stalls and
/// waiting senders are those of a whole link; the sink's half has the messages and the statistics. The
/// messages sent and read in a cycle go into `out()` and are delivered to the other rank's halves at the end
/// of the same cycle. Writes and reads become visible in the next cycle anyway, so neither end sees a
/// difference from a whole link.
///
/// Both ranks must add their halves in the same order: the order gives a half its number, which names it in
/// records.
class SplitLinks {
  public:
    SplitLinks() = default;
    SplitLinks(const SplitLinks&) = delete;
    SplitLinks& operator=(const SplitLinks&) = delete;

    /// Makes a half link, owned by this object.
    Link& make_source(Scheduler& scheduler, int classes, int depth, std::uint32_t used = Link::all_classes);
    Link& make_sink(Scheduler& scheduler, int classes, int depth);
    /// Adds a half link that the caller owns; it must outlive this object, and must have no other observer.
    void add_source(Link& half);
    void add_sink(Link& half);
    std::size_t halves() const { return ends_.size(); }
    /// The half link of this number.
    const Link& half(std::size_t number) const { return *ends_[number]->link; }
    bool has_source(std::size_t number) const { return ends_[number]->source; }

    /// Records of the messages sent and read since the last clear(). The first `prefix` bytes are for the
    /// transport.
    Bytes& out() { return out_; }
    /// Keeps `prefix` bytes free at the beginning of out().
    void set_prefix(std::size_t prefix);
    /// To be called when out() has been handed over: gives the sent messages' objects back to their pools and
    /// empties out() except for its prefix.
    void clear(MessagePools& pools);

    /// Delivers the content of the other rank's out() behind its prefix, in the cycle in which it was sent.
    /// Receivers of answers are woken `answers_later` cycles after the arrival (Link::send()). Throws
    /// std::logic_error for records that no rank of the same machine can have sent.
    void deliver(const std::byte* data, std::size_t size, MessagePools& pools, int answers_later = 0);

  private:
    class End : public LinkObserver {
      public:
        End(SplitLinks& owner, Link& half, std::uint32_t half_number, bool is_source)
            : link(&half), number(half_number), source(is_source), owner_(owner) {}
        void sent(const Link&, int index, const Message& message, int cycles, Cycle now) override;
        void popped(const Link&, int index, const Message& message, Cycle now) override;

        Link* link;
        std::uint32_t number;
        bool source;

      private:
        SplitLinks& owner_;
    };
    void add(Link& half, bool source);
    template <typename T>
    void put(const T& value);
    void put_message(std::uint32_t number, int index, const Message& message, int cycles);

    std::vector<std::unique_ptr<End>> ends_;
    std::vector<std::unique_ptr<Link>> made_;
    std::vector<Message> gone_;  ///< sent since the last clear(); their objects still belong to this rank
    Bytes out_;
    std::size_t prefix_ = 0;
};

}  // namespace raycell
