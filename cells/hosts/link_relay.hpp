// Joins a cell, which reads Links, to channels of somebody else's.
#pragma once

#include "cells/channels/link.hpp"

namespace raycell {

/// Shows a cell what stands at the heads of another channel's buffers, through a Link of its own: a message
/// leaves the channel when the cell takes it.
class InputRelay : private LinkObserver {
  public:
    /// `channel` must outlive it; of so many classes.
    InputRelay(Scheduler& scheduler, int classes, LinkIn& channel);

    Link& link() { return link_; }
    /// Before each step of the cell: looks at the heads that have arrived since the last.
    void look();

  private:
    void look(int index);
    void sent(const Link&, int, const Message&, int, Cycle) override {}
    void popped(const Link& link, int index, const Message& message, Cycle now) override;

    LinkIn& channel_;
    Link link_;
};

}  // namespace raycell
