#include "testbench/cell/loading_export.hpp"

#include <algorithm>
#include <deque>
#include <sstream>

#include "model/loading/voxel.hpp"
#include "testbench/cell/load_files.hpp"
#include "testbench/cell/load_machine.hpp"
#include "testbench/cell/visit_calls.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/golden/messages.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {
namespace {

using Word = LoadMachine::Word;
using Words64 = std::vector<Word>;

Word raw(const Format& format, double value) { return Word(std::int64_t(value / format.step())); }

/// What the unit has to write out of a cell, from the model's own store.
class ExpectedWords {
  public:
    ExpectedWords(const Context& context, const LoadCalls& calls)
        : context_(context), calls_(calls), visit_(context) {}

    Words64 of(LoadPort port, const CellStore& store, const std::vector<std::uint32_t>& objects,
               bool sources) const {
        Words64 words;
        if (port == LoadPort::store) {
            add_lines(store, words);
        } else if (port == LoadPort::voxels) {
            for (const Voxel& voxel : store.voxels) {
                const auto number = std::find(objects.begin(), objects.end(), voxel.object) - objects.begin();
                add_voxel(voxel, std::size_t(number), words);
            }
        } else if (port == LoadPort::objects) {
            for (const std::uint32_t object : objects) add_object(context_.objects.at(object), words);
        } else if (sources) {
            for (const Source& source : context_.lights.sources) add_source(source, words);
        }
        return words;
    }

  private:
    /// The traversal's store.
    void add_lines(const CellStore& store, Words64& words) const {
        const std::size_t edges = calls_.line_stride() * store.index.size();
        for (const IndexEntry& line : store.index) {
            const Voxel& v = store.voxels[line.voxel];
            const std::map<std::string, double> value = {
                {"number", line.voxel},
                {"polygon", v.polygon},
                {"near", v.near},
                {"far", v.far},
                {"most", line.most},
                {"nx", v.plane.n.x},
                {"ny", v.plane.n.y},
                {"nz", v.plane.n.z},
                {"c", v.plane.c},
                {"drop x", v.drop == 0},
                {"drop z", v.drop == 2},
                {"edges", v.pieces ? v.edge_count : 0},
                {"first", double(edges + v.first_edge * calls_.edge_stride())}};
            for (const std::string& name : visit_.voxel_fields())
                words.push_back(visit_.word(ValueSpace::voxel, name, value.at(name)));
        }
        for (const EdgeFunction& e : store.edges) {
            const std::map<std::string, double> value = {{"a", e.a}, {"b", e.b}, {"c", e.c}};
            for (const std::string& name : visit_.edge_fields())
                words.push_back(visit_.word(ValueSpace::edge, name, value.at(name)));
            words.push_back(e.piece);
        }
    }
    void add_voxel(const Voxel& v, std::size_t object, Words64& words) const {
        const Formats& f = context_.arithmetic.formats();
        words.insert(words.end(), {Word(object), Word(v.polygon), raw(f.depth, v.base), Word(v.drop == 0),
                                   Word(v.drop == 2)});
        for (int axis = 0; axis < 3; ++axis) words.push_back(raw(f.unit, v.plane.n[axis]));
        for (const dvec3& normal : {v.normal.base, v.normal.du, v.normal.dv}) {
            for (int axis = 0; axis < 3; ++axis) words.push_back(raw(f.normal, normal[axis]));
        }
    }
    void add_object(const Material& m, Words64& words) const {
        const Formats& f = context_.arithmetic.formats();
        const NumberSettings& numbers = context_.settings.numbers;
        const Operators operators(numbers.operators, numbers.word_bits, numbers.rounding);
        for (const double share : {m.colour.x, m.colour.y, m.colour.z, m.diffuse, m.specular, m.transmit,
                                   m.mirror ? m.specular : 0})
            words.push_back(raw(f.feature, share));
        words.push_back(raw(operators.exponent_word(), operators.exponent_word().hold(m.shine)));
        words.push_back(raw(f.ior, m.ior));
    }
    void add_source(const Source& source, Words64& words) const {
        const Formats& f = context_.arithmetic.formats();
        const int exponent = f.place_exponent(source.position);
        const Format mantissa(1, f.word_bits + 11);
        for (int axis = 0; axis < 3; ++axis)
            words.push_back(raw(mantissa, scale_by(source.position[axis], -exponent)));
        words.push_back(exponent);
        for (int channel = 0; channel < 3; ++channel)
            words.push_back(raw(f.intensity, source.intensity[channel]));
    }

    const Context& context_;
    const LoadCalls& calls_;
    const VisitCalls visit_;
};

struct Totals {
    std::size_t cells = 0, spans = 0, made = 0, voxels = 0, edges = 0, joins = 0, lines = 0;
    std::uint64_t charged = 0, cycles = 0, copies = 0, steps = 0, finish = 0;
};

/// One cell's messages, on the model and on the script.
class CellLoading {
  public:
    CellLoading(const LoadRecord& record, const Context& context, const LoadCalls& calls, int message_bits)
        : record_(record),
          context_(context),
          calls_(calls),
          words_(context.arithmetic, record.setup->picture),
          machine_(calls, record.setup->x),
          digits_(std::size_t(message_bits) / 4) {
        for (const GoldenEvent& event : *record.events) {
            if (event.what == GoldenEvent::What::out && is_load(event)) out_.push_back(&event);
        }
    }

    void run(Totals& totals) {
        ++totals.cells;
        for (const GoldenEvent& event : *record_.events) {
            if (event.what == GoldenEvent::What::in && is_load(event)) take(event, totals);
        }
        const LoadMachine::Result done = machine_.finish();
        finish_steps_ = done.steps;
        totals.finish += done.steps;
        totals.voxels += store_.voxels.size();
        totals.edges += store_.edges.size();
        const ExpectedWords expected(context_, calls_);
        static const char* const names[] = {"store", "voxels", "objects", "sources"};
        for (std::size_t i = 0; i < 4; ++i) {
            const Words64 wanted = expected.of(LoadPort(i), store_, objects_, sources_);
            const Words64& found = machine_.written(LoadPort(i));
            for (std::size_t at = 0; at < std::max(wanted.size(), found.size()); ++at) {
                if (at >= wanted.size() || at >= found.size() || wanted[at] != found[at])
                    fail(std::string("the microprograms' ") + names[i] + " word " + std::to_string(at) +
                         " is " + (at < found.size() ? std::to_string(std::int64_t(found[at])) : "missing") +
                         ", expected " +
                         (at < wanted.size() ? std::to_string(std::int64_t(wanted[at])) : "no more"));
            }
        }
    }

    const std::string& vectors() const { return vectors_; }
    std::string words(int bits) const {
        std::string text;
        for (std::size_t i = 0; i < 4; ++i) {
            for (const Word word : machine_.written(LoadPort(i)))
                text += MicroImage::hexadecimal(word, bits) + "\n";
        }
        return text;
    }
    /// Column, messages, words of each port, voxels' words of the traversal's store, cycles of finishing.
    std::string index() const {
        std::string line = std::to_string(record_.setup->x) + " " + std::to_string(messages_);
        for (std::size_t i = 0; i < 4; ++i)
            line += " " + std::to_string(machine_.written(LoadPort(i)).size());
        return line + " " + std::to_string(std::int64_t(machine_.field("lines end"))) + " " +
               std::to_string(finish_steps_) + "\n";
    }
    void grow(LoadSizes& sizes) const {
        for (std::size_t i = 0; i < 3; ++i)
            sizes.memories[i] = std::max(sizes.memories[i], machine_.memory_words(LoadMemory(i)));
        for (std::size_t i = 0; i < 4; ++i)
            sizes.ports[i] = std::max(sizes.ports[i], machine_.written(LoadPort(i)).size());
    }

  private:
    static bool is_load(const GoldenEvent& event) {
        const std::string& type = event.tokens.at(0);
        return type == "setup" || type == "features" || type == "span" || type == "end_of_scene";
    }
    [[noreturn]] void fail(const std::string& what) const { throw GoldenError(record_.name + ": " + what); }

    void take(const GoldenEvent& event, Totals& totals) {
        const Message message = read_message(words_, event.tokens, event.remarks, {}, pools_);
        const LoadItem item = *message.load;
        give_back(message, pools_);
        const bool span = item.kind == LoadItem::Kind::span;
        const bool makes = span && item.span.x == record_.setup->x;
        const bool ends =
            span ? item.span.last == record_.setup->x : record_.setup->x + 1 == record_.setup->picture.width;
        if (item.kind == LoadItem::Kind::features) objects_.push_back(item.object);
        sources_ = sources_ || item.kind == LoadItem::Kind::setup;
        if (event.bits.empty()) fail("a load message without bits");
        const std::string at = "line " + std::to_string(event.line) + ": the microprograms' ";
        const LoadMachine::Result result = machine_.take(padded(event.bits));
        const std::size_t before = store_.voxels.size();
        const std::uint32_t lines = makes ? store_voxel(store_, item.span, context_.settings,
                                                        context_.scene.frame.level(), context_.arithmetic)
                                          : 0;
        if (result.lines != lines)
            fail(at + "lines are " + std::to_string(result.lines) + ", expected " + std::to_string(lines));
        if (result.made != (lines > 0)) fail(at + "voxel is made or not, expected the other");
        if (makes && result.ends != ends) fail(at + "span ends or not, expected the other");
        if (!ends) {
            if (out_.empty()) fail(at + "message goes on, expected none");
            if (makes && result.advanced != padded(out_.front()->bits))
                fail(at + "message that goes on differs from line " + std::to_string(out_.front()->line));
            out_.pop_front();
        }
        ++messages_;
        for (const std::string& word : {padded(event.bits), result.advanced}) vectors_ += word + " ";
        for (const std::uint64_t n : {std::uint64_t(result.made), std::uint64_t(result.ends),
                                      std::uint64_t(lines), result.cycles, result.copies, result.steps})
            vectors_ += MicroImage::hexadecimal(Word(n), 32) + " ";
        vectors_.back() = '\n';
        totals.copies += result.copies;
        totals.steps += result.steps;
        totals.cycles += result.cycles;
        totals.charged += result.charged;
        totals.spans += makes;
        totals.made += result.made;
        totals.lines += lines;
        totals.joins += result.made && store_.voxels.size() == before;
    }
    std::string padded(const std::string& digits) const {
        return digits + std::string(digits_ - std::min(digits_, digits.size()), '0');
    }

    const LoadRecord& record_;
    const Context& context_;
    const LoadCalls& calls_;
    Words words_;
    LoadMachine machine_;
    std::size_t digits_;
    MessagePools pools_;
    CellStore store_;
    std::deque<const GoldenEvent*> out_;
    std::string vectors_;
    std::size_t messages_ = 0;
    std::vector<std::uint32_t> objects_;  ///< in the order in which their features came
    bool sources_ = false;
    std::uint64_t finish_steps_ = 0;
};

}  // namespace

std::string export_loading(const std::vector<LoadRecord>& records, const std::string& folder) {
    const CellSetup& setup = *records.front().setup;
    const Context context(setup.scene, setup.picture);
    const LoadCalls calls(context);
    const MicroImage image = image_of({&calls.unit()});
    const int message_bits = (Packing(context, setup.machine).widest() + 3) / 4 * 4;
    OutputSet files(folder + "/");
    Totals totals;
    LoadSizes sizes;
    std::vector<std::pair<std::string, std::string>> all;
    std::string index;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Context own(records[i].setup->scene, records[i].setup->picture);
        const LoadCalls own_calls(own);
        const MicroImage own_image = image_of({&own_calls.unit()});
        if (own_image.package() + own_image.instruction_file() != image.package() + image.instruction_file())
            throw GoldenError(records[i].name + ": its microprograms differ from those of " +
                              records.front().name + "; expected records of one run");
        CellLoading cell(records[i], own, own_calls, message_bits);
        cell.run(totals);
        cell.grow(sizes);
        index += cell.index();
        const std::string number = "_" + std::to_string(i) + ".hex";
        all.emplace_back("messages" + number, cell.vectors());
        all.emplace_back("written" + number, cell.words(image.register_bits()));
    }
    std::string names;
    for (const std::string& name : calls.unit().fields()) names += name_in_file(name) + "\n";
    for (auto& file : load_files(calls, image, sizes)) all.push_back(std::move(file));
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"microcode.sv", image.package()}, {"fields.txt", names}, {"loads.txt", index}})
        all.emplace_back(name, text);
    std::vector<std::string> suffixes;
    for (const auto& [name, text] : all) suffixes.push_back(name);
    files.announce(suffixes);
    for (const auto& [name, text] : all) files.write(name, text);
    files.publish();
    std::ostringstream said;
    said << folder << ": " << totals.cells << " cells, " << totals.spans << " spans, " << totals.voxels
         << " voxels, " << totals.joins << " joins, " << totals.edges << " edges, " << totals.lines
         << " lines; the programs take " << totals.cycles << " cycles, " << totals.charged
         << " of them of programs in the cost table, which says "
         << totals.spans * std::uint64_t(setup.machine.costs.load_voxel(setup.picture.hit)) +
                totals.spans * std::uint64_t(setup.machine.costs.load_advance) +
                totals.lines * std::uint64_t(setup.machine.costs.load_order)
         << ", and " << totals.copies << " copies, " << totals.steps << " steps of the script, "
         << totals.finish << " cycles to write out\n";
    return said.str();
}

}  // namespace raycell
