// Reports the messages of a machine's loading pipeline to a listener.
#pragma once

#include <vector>

#include "pipeline/machine.hpp"
#include "testbench/loading/watch.hpp"

namespace raycell::loading {

/// Watches the loading links of a machine. Machine, layout and listener must outlive it.
class MachineTap {
  public:
    MachineTap(Machine& machine, const Layout& layout, LoadListener& listener);
    ~MachineTap();
    MachineTap(const MachineTap&) = delete;
    MachineTap& operator=(const MachineTap&) = delete;

  private:
    class LinkTap : public LinkObserver {
      public:
        LinkTap(LoadListener& listener, std::size_t index) : listener_(listener), index_(index) {}
        void sent(const Link& link, int index, const Message& message, int cycles, Cycle now) override;
        void popped(const Link& link, int index, const Message& message, Cycle now) override;

      private:
        LoadListener& listener_;
        std::size_t index_;
    };
    void listen(Link& link, std::size_t index);

    LoadListener& listener_;
    std::vector<LinkTap> taps_;
    std::vector<Link*> links_;
};

}  // namespace raycell::loading
