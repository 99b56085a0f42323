#include "testbench/cell/visit_files.hpp"

#include "testbench/cell/hardware_text.hpp"

namespace raycell {

MicroImage image_of(const VisitCalls& calls) {
    std::vector<const MicroProgram*> programs;
    for (const auto& program : calls.programs()) programs.push_back(program.get());
    return MicroImage(programs, true);
}

VisitFiles visit_files(const VisitCalls& v, const MicroImage& image, std::size_t store_words, bool edges) {
    const int address = std::max(bits_of(image.register_count()), bits_of(v.fields().size()));
    const int source = std::max({bits_of(v.fields().size()), bits_of(v.voxel_fields().size()),
                                 bits_of(v.edge_fields().size() + 1), bits_of(image.register_count())});
    const int entry = image.entry_bits();
    std::size_t copies = 0;
    for (const VisitCall& c : v.calls()) copies += c.loads.size() + c.stores.size();
    const int copy = bits_of(copies + 1);
    VisitFiles files;
    std::size_t at = 0;
    // From: 0 a field, 1 a voxel, 2 an edge, 3 a register. To: 0 a register, 1 a field.
    const auto add_copy = [&](unsigned from, std::size_t number, bool to_field, std::size_t to) {
        const MicroMachine::Value word = MicroMachine::Value(from) << (source + 1 + address) |
                                         MicroMachine::Value(number) << (1 + address) |
                                         MicroMachine::Value(to_field) << address | MicroMachine::Value(to);
        files.copies += MicroImage::hexadecimal(word, 2 + source + 1 + address) + "\n";
        ++at;
    };
    for (const VisitCall& c : v.calls()) {
        const RegisterIndex base = image.first_register(c.program);
        const std::size_t first = at;
        for (const Transfer& t : c.loads)
            add_copy(unsigned(t.space), t.from, t.to_field, t.to_field ? t.to : base + t.to);
        const std::size_t middle = at;
        for (const auto& [from, to] : c.stores) add_copy(3, base + from, true, to);
        const MicroMachine::Value word =
            ((MicroMachine::Value(first) << copy | MicroMachine::Value(middle)) << copy |
             MicroMachine::Value(at))
                << entry |
            MicroMachine::Value(image.entry(c.program));
        files.calls += "// " + c.name + "\n" + MicroImage::hexadecimal(word, 3 * copy + entry) + "\n";
    }
    PackageText package("visit", "fields, calls and copies of the traversal unit.");
    package.sizes(image);
    const auto number = [&](const std::string& name, std::size_t value) { package.number(name, value); };
    number("FIELDS", v.fields().size());
    number("FIELD_BITS", std::size_t(bits_of(v.fields().size())));
    number("STORE_WORDS", std::max<std::size_t>(store_words, 1));
    number("STORE_BITS", std::size_t(bits_of(store_words + 1)));
    number("VOXEL_WORDS", v.voxel_fields().size());
    number("EDGE_WORDS", v.edge_fields().size() + 1);
    number("HAS_EDGES", edges);
    number("SOURCE_BITS", std::size_t(source));
    number("TO_BITS", std::size_t(address));
    number("COPIES", copies);
    number("COPY_BITS", std::size_t(copy));
    number("CALLS", v.calls().size());
    number("CALL_BITS", std::size_t(bits_of(v.calls().size())));
    for (std::size_t i = 0; i < v.fields().size(); ++i) number("F_" + constant_name(v.fields()[i]), i);
    for (std::size_t i = 0; i < v.calls().size(); ++i) number("CALL_" + constant_name(v.calls()[i].name), i);
    if (!edges) {  // named, not used
        for (const char* name : {"F_EDGES", "F_FIRST", "F_INSIDE", "CALL_PROJECTION", "CALL_EDGE"})
            number(name, 0);
    }
    files.package = package.text();
    return files;
}

}  // namespace raycell
