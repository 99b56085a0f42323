// Connects a cell, which reads Links, to a user's own channels.
#pragma once

#include "cells/channels/link.hpp"

namespace raycell {

/// Shows a cell the heads of another channel's buffers through a Link of its own. A message leaves the
/// channel when the cell takes it.
class InputRelay : private LinkObserver {
  public:
    /// `channel`, which has `classes` classes, must outlive this object.
    InputRelay(Scheduler& scheduler, int classes, LinkIn& channel);

    Link& link() { return link_; }
    /// To be called before each step of the cell: takes over the heads that have arrived since the last step.
    void look();

  private:
    void look(int index);
    void sent(const Link&, int, const Message&, int, Cycle) override {}
    void popped(const Link& link, int index, const Message& message, Cycle now) override;

    LinkIn& channel_;
    Link link_;
};

}  // namespace raycell
