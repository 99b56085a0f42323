// The library of a verilated cell, with voxels or without: what its ports say, as acts of a cell.
#include <dlfcn.h>

#include <algorithm>
#include <filesystem>

#include "testbench/rtl/array/rtl_cell.hpp"
#include "testbench/rtl/bench/verilated_cell.hpp"

namespace rtl {
namespace {

constexpr int time_bits = 48;

constexpr int bits_to_hold(int value) { return value == 0 ? 0 : 1 + bits_to_hold(value / 2); }

CellPlace place_of(int place) {
    if (place == own_place) return {own_register, 0};
    if (place > own_place) return {slot_register, place - own_place - 1};
    return {place / ray_classes, place % ray_classes};
}

class PortCell : public ArrayCell {
  public:
    PortCell(VerilatedContext& context, int x, int y) : cell_(context, x, y), first_column_(x == 0) {}

    void reset(const std::string& viewer) override { cell_.reset(viewer); }
    void begin(std::uint64_t now) override { cell_.begin(now); }
    void phase(int code, bool begins) override { cell_.phase(code, begins); }
    void drain(bool on) override { cell_.drain(on); }
    void settle() override { cell_.settle(); }
    void arrives(int side, int index, const std::string& digits, std::uint64_t id) override {
        cell_.in(side, index, 1, digits, id);
    }
    void frees(int side, int index) override { cell_.free(side, index); }
    void clock() override { cell_.clock(); }

    const std::vector<CellAct>& acts() override;
    CellMessage sent(int side) const override {
        Sent sent = cell_.sent(side);
        return {sent.index, sent.cycles, std::move(sent.message), bits_at(cell_.top().out_id, 64 * side, 64)};
    }
    std::vector<std::uint64_t> pixel() const override {
        std::vector<std::uint64_t> words;
        for (int i = 0; i < 3; ++i)
            words.push_back(bits_at(cell_.top().pixel, (2 - i) * word_bits, word_bits));
        return words;
    }
    bool idle() const override { return cell_.idle(); }
    bool still() const override { return cell_.top().still; }
    std::string refusal() const override {
#ifdef RTL_WHOLE
        if (cell_.late()) return "the microprograms took longer than the cost table says";
        return cell_.makes_voxel() ? "its memories hold no more voxels or edges (--voxels, --edges)" : "";
#else
        return cell_.makes_voxel() ? "a span begins here, and this cell makes no voxels" : "";
#endif
    }
    bool makes_voxels() const override { return replies > 0; }
    bool has_ids() const override { return true; }

  private:
    void add_requests(bool rays_in_time);
    void add_launches();
    void add_tests();
    void add_job();

    void add_request(int number, std::uint64_t since);
    void act(CellAct::What what, CellPlace place, int slot = 0, bool first = false);

    VerilatedCell cell_;
    bool first_column_;
    int ended_ = -1;  ///< slot whose job ended in the last cycle
    std::vector<CellAct> acts_;
};

const std::vector<CellAct>& PortCell::acts() {
    acts_.clear();
    const CellPlace load = {first_column_ ? load_link : 2, 0};
    if (cell_.top().phase == 0) {
        if (cell_.takes(load.side, 0))
            acts_.push_back({CellAct::What::load, load, cell_.sends(0) ? 0 : to_nobody});
#ifdef RTL_WHOLE
        if (cell_.top().loaded) acts_.push_back({CellAct::What::loaded});
#endif
        return acts_;
    }
#ifdef RTL_WHOLE
    if (ended_ >= 0) act(CellAct::What::shaded, {}, ended_);
    ended_ = -1;
#endif
    add_requests(false);
    add_launches();
    add_requests(true);
    add_tests();
    add_job();
    return acts_;
}

void PortCell::act(CellAct::What what, CellPlace place, int slot, bool first) {
    CellAct act;
    act.what = what;
    act.place = place;
    act.slot = slot;
    act.first = first;
    acts_.push_back(act);
}

void PortCell::add_launches() {
    if (cell_.top().feed) act(CellAct::What::launch, {own_register, 0});
#ifdef RTL_WHOLE
    for (int i = 0; i < replies; ++i) {
        if (bits_at(cell_.top().feeds, i, 1)) act(CellAct::What::launch, {slot_register, i});
    }
#endif
}

void PortCell::add_job() {
#ifdef RTL_WHOLE
    const Top& top = cell_.top();
    if (top.shading_starts) act(CellAct::What::shades, {}, int(top.starts_slot), !top.starts_shade);
    if (top.shading_ends) ended_ = int(top.job_slot);
#endif
}

/// What leaves or asks to: overdue messages, answers and replies, or (`rays_in_time`) the other rays; the
/// oldest of each first. Of replies all are overdue if one is.
void PortCell::add_requests(bool rays_in_time) {
    const Top& top = cell_.top();
    if (!top.asks) return;
    struct Request {
        int group;
        std::uint64_t since;
        int number;
        bool operator<(const Request& other) const {
            if (group != other.group) return group < other.group;
            return since != other.since ? since < other.since : number < other.number;
        }
    };
    const auto since = [&](int i) { return bits_at(top.asks_since, time_bits * i, time_bits); };
    std::uint64_t first_reply = ~std::uint64_t(0);
    for (int i = sides; i < first_ray; ++i) {
        if (bits_at(top.overdue, i, 1)) first_reply = std::min(first_reply, since(i));
    }
    const bool reply_overdue = first_reply != ~std::uint64_t(0);
#ifdef RTL_WHOLE
    const bool replies_first = top.replies_first;
#else
    const bool replies_first = false;
#endif
    std::vector<Request> order;
    for (int i = 0; i < requesters; ++i) {
        if (!bits_at(top.asks, i, 1)) continue;
        const bool reply = i >= sides && i < first_ray;
        const bool overdue = reply ? reply_overdue : bits_at(top.overdue, i, 1) != 0;
        if (rays_in_time != (i >= first_ray && !overdue)) continue;
        const int group = overdue ? 0 : reply == replies_first ? 1 : 2;
        order.push_back({group, !reply ? since(i) : overdue ? first_reply : 0, i});
    }
    std::sort(order.begin(), order.end());
    for (const Request& request : order) add_request(request.number, since(request.number));
}

void PortCell::add_request(int i, std::uint64_t since) {
    const Top& top = cell_.top();
    const bool ray = i >= first_ray;
    CellAct act;
    act.what = ray ? CellAct::What::ray : i < sides ? CellAct::What::answer : CellAct::What::reply;
    act.place = ray ? place_of(i - first_ray) : CellPlace{i, answers};
    act.slot = i - sides;
    act.to =
        ray && bits_at(top.ends_silently, i - first_ray, 1) ? to_nobody : int(bits_at(top.goal, 3 * i, 3));
    act.waits = !bits_at(top.goes, i, 1);
    act.full = bits_at(top.stalls_full, i, 1);
    act.since = since;
#ifdef RTL_WHOLE
    // One hit takes a slot in a cycle.
    if (ray && bits_at(top.hits, i - first_ray, 1) && !act.waits && top.takes_slot &&
        int(top.takes_place) == i - first_ray) {
        act.to = to_slot;
        act.slot = int(top.takes);
    }
#endif
    acts_.push_back(act);
}

void PortCell::add_tests() {
    const Top& top = cell_.top();
    constexpr int index_bits = bits_to_hold(places);  // as $clog2(places + 1)
    for (int unit = 0; unit < traversal_units; ++unit) {
        if (!(top.test_starts >> unit & 1)) continue;
        const int place = int(bits_at(top.test_place, index_bits * unit, index_bits));
        act(CellAct::What::test, place_of(place));
    }
}

VerilatedContext& context() {
    static VerilatedContext one;
    return one;
}

/// Microprograms are files above the folder of the library, read from the current folder when a cell is made.
class InFolderOfLibrary {
  public:
    InFolderOfLibrary() {
        Dl_info info;
        if (dladdr(reinterpret_cast<const void*>(&context), &info))
            std::filesystem::current_path(std::filesystem::path(info.dli_fname).parent_path().parent_path());
    }
    ~InFolderOfLibrary() { std::filesystem::current_path(before_); }

  private:
    const std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace
}  // namespace rtl

extern "C" rtl::ArrayCell* rtl_make_cell(int x, int y) {
    const rtl::InFolderOfLibrary here;
    auto* cell = new rtl::PortCell(rtl::context(), x, y);
    cell->settle();
    return cell;
}

extern "C" bool rtl_put_fault(int fault) {
#ifdef RTL_FAULTS
    rtl::fault_of_all = fault;
    return true;
#else
    return fault == 0;
#endif
}
