// Links whose two ends are in machines of different ranks: each rank has a link of its own, half of the
// whole.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "cells/channels/link.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

/// All halves that a rank shares with one other rank.
///
/// The source's half keeps its messages until the far end has read them, so room, wires, stalls and who waits
/// for room are the whole link's; the sink's half has the messages and the statistics. What is sent and read
/// in a cycle goes into `out()`, and is delivered to the other rank's halves at the end of that same cycle:
/// as the writes and reads of a cycle show in the next one, neither end can tell the halves from a whole.
///
/// Both ranks must add their halves in the same order: a half's number is its name on the way.
class SplitLinks {
  public:
    SplitLinks() = default;
    SplitLinks(const SplitLinks&) = delete;
    SplitLinks& operator=(const SplitLinks&) = delete;

    /// A new half, kept here.
    Link& make_source(Scheduler& scheduler, int classes, int depth, std::uint32_t used = Link::all_classes);
    Link& make_sink(Scheduler& scheduler, int classes, int depth);
    /// Halves of somebody else's, who must keep them. Nobody else may observe them.
    void add_source(Link& half);
    void add_sink(Link& half);
    std::size_t halves() const { return ends_.size(); }
    /// The half of this number.
    const Link& half(std::size_t number) const { return *ends_[number]->link; }
    bool has_source(std::size_t number) const { return ends_[number]->source; }

    /// What was sent and read since the last clear(). The first `prefix` bytes are for whoever carries it.
    Bytes& out() { return out_; }
    /// Keeps `prefix` bytes free at the beginning of out().
    void set_prefix(std::size_t prefix);
    /// What went out is now the other rank's: gives back what carried it, and empties out() but its prefix.
    void clear(MessagePools& pools);

    /// What the other rank's out() held behind its prefix, in the cycle in which it was sent. Receivers of
    /// answers are woken `answers_later` cycles after their arrival (Link::send()). Throws std::logic_error
    /// for what no rank of the same machine can have sent.
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
    std::vector<Message> gone_;  ///< their objects are this rank's still
    Bytes out_;
    std::size_t prefix_ = 0;
};

}  // namespace raycell
