#include "cells/hosts/link_relay.hpp"

namespace raycell {

// Depth 2: the next message is put in while the one before it is still being taken out.
InputRelay::InputRelay(Scheduler& scheduler, int classes, LinkIn& channel)
    : channel_(channel), link_(scheduler, classes, 2) {
    link_.set_observer(this);
}

void InputRelay::look() {
    for (int index = 0; index < link_.classes(); ++index) {
        if (link_.occupancy(index) == 0) look(index);
    }
}

void InputRelay::look(int index) {
    const Message head = channel_.front(index);
    if (head.kind != Message::Kind::none) link_.put(index, head, channel_.arrival(index));
}

void InputRelay::popped(const Link& /*link*/, int index, const Message& /*message*/, Cycle /*now*/) {
    channel_.pop(index);
    look(index);
}

}  // namespace raycell
