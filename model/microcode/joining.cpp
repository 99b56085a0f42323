// Programs around the making of a voxel: another piece joins it, its place in the index table, and what else
// a cell keeps of load messages (loading/voxel.cpp, loading/index_table.cpp). They are not in the cost table.
#include "model/microcode/loading.hpp"
#include "model/numbers/operators.hpp"

namespace raycell {

void LoadingWriter::join() {
    const Format& unit = formats_.unit;
    const Format& depth = formats_.depth;
    const auto depth_reg = [&](const char* name) { return a_.reg(name, far_bits(), depth.fraction_bits()); };
    drop_z_ = number("drop z");
    area_ = length("twice area", 1);
    const RegisterIndex near_level = number_of("piece near level", 20);
    const RegisterIndex far_level = number_of("piece far level", 20);
    const RegisterIndex near = depth_reg("piece near");
    const RegisterIndex u = a_.reg("piece point u", unit.bits(), unit.fraction_bits());
    const RegisterIndex v =
        a_.reg("piece point v", depth.integer_bits() + 1 + unit.fraction_bits(), unit.fraction_bits());
    const RegisterIndex area = length("piece area", 1);
    const RegisterIndex before = depth_reg("near before");
    const RegisterIndex way = depth_reg("way");
    const RegisterIndex piece_way = depth_reg("piece way");
    a_.least(near_level_, near_level_, near_level);
    a_.most(far_level_, far_level_, far_level);
    a_.jump_less(area_, area, "larger");
    a_.jump("point");
    a_.label("larger");
    a_.move(area_, area);
    a_.move(held_u_, u);
    a_.move(held_v_, v);
    a_.label("point");
    a_.move(before, near_);
    ends();
    a_.subtract(way, near_, before);
    a_.subtract(piece_way, near_, near);
    a_.move(anchor_v_, held_v_);
    a_.jump_less(zero_, drop_z_, "anchored");
    a_.difference(anchor_v_, held_v_, near_);
    a_.label("anchored");
}

MicroProgram join_program(const MicroSetting& setting, const DepthLevels& levels) {
    Assembler a("join", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, levels);
    writer.take_run();
    writer.take_anchor();
    writer.join();
    a.end();
    return a.finish();
}

MicroProgram components_program(const MicroSetting& setting) {
    const Format unit = setting.formats().unit;
    Assembler a("components", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const char* name) { return a.reg(name, unit.bits(), unit.fraction_bits()); };
    const RegisterIndex u = reg("plane u");
    const RegisterIndex v = reg("plane v");
    const RegisterIndex negative = a.reg("negative", 2, 0);
    const RegisterIndex drop_x = a.reg("drop x", 2, 0);
    const RegisterIndex drop_z = a.reg("drop z", 2, 0);
    const RegisterIndex x = reg("nx");
    const RegisterIndex y = reg("ny");
    const RegisterIndex z = reg("nz");
    const RegisterIndex size = reg("size");
    const std::int64_t one = std::int64_t(1) << unsigned(unit.fraction_bits());
    const RegisterIndex plus = a.constant("1", one, unit.bits(), unit.fraction_bits());
    const RegisterIndex minus = a.constant("-1", -one, unit.bits(), unit.fraction_bits());
    a.move(size, plus);
    a.jump_zero(negative, "sign");
    a.move(size, minus);
    a.label("sign");
    a.jump_zero(drop_x, "x stays");
    a.move(x, size);
    a.move(y, u);
    a.move(z, v);
    a.end();
    a.label("x stays");
    a.move(x, u);
    a.jump_zero(drop_z, "z stays");
    a.move(y, v);
    a.move(z, size);
    a.end();
    a.label("z stays");
    a.move(y, size);
    a.move(z, v);
    a.end();
    return a.finish();
}

MicroProgram move_edge_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("move edge", setting.datapath, setting.numbers.rounding);
    const RegisterIndex b = a.reg("b", f.unit.bits(), f.unit.fraction_bits());
    const RegisterIndex c = a.reg("c", f.edge_offset.bits(), f.edge_offset.fraction_bits());
    const RegisterIndex way = a.reg("way", f.depth.bits() + 1, f.depth.fraction_bits());
    a.sum(c, c, {{b, way}});
    a.end();
    return a.finish();
}

MicroProgram widen_program(const MicroSetting& setting) {
    const Format depth = setting.formats().depth;
    Assembler a("widen", setting.datapath, setting.numbers.rounding);
    const RegisterIndex most = a.reg("most", depth.bits() + 1, depth.fraction_bits());
    const RegisterIndex far = a.reg("far", depth.bits() + 1, depth.fraction_bits());
    a.most(most, most, far);
    a.end();
    return a.finish();
}

MicroProgram shine_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    const Operators operators(setting.numbers.operators, setting.numbers.word_bits, setting.numbers.rounding);
    const Format& word = operators.exponent_word();
    const int bits = f.shine_bits - Formats::shine_exponent_bits;
    Assembler a("shine", setting.datapath, setting.numbers.rounding);
    const RegisterIndex exponent = a.reg("exponent", 8, 0);
    const RegisterIndex fraction = a.reg("fraction", bits + 2, 0);
    const RegisterIndex shine = a.reg("shine", word.bits(), word.fraction_bits());
    const RegisterIndex mantissa = a.reg("mantissa", bits + 2, 0);
    const RegisterIndex by = a.reg("by", 8, 0);
    const RegisterIndex whole = a.constant("whole", std::int64_t(1) << unsigned(bits), bits + 2, 0);
    const RegisterIndex from = a.constant("from", 9, 8, 0);
    const int most_bits = word.integer_bits() - 2;  // the model's powers go up to 2^it
    const RegisterIndex too_much = a.constant("too much", most_bits, 8, 0);
    const RegisterIndex none = a.constant("none", 0, 2, word.fraction_bits());
    const RegisterIndex most =
        a.constant("most", std::int64_t(1) << unsigned(most_bits + word.fraction_bits()), word.bits(),
                   word.fraction_bits());
    a.move(shine, none);
    a.jump_zero(exponent, "done");
    a.subtract(by, exponent, from);
    a.move(shine, most);
    a.jump_less(by, too_much, "within");
    a.end();
    a.label("within");
    a.add(mantissa, fraction, whole);
    a.scale(shine, mantissa, by, bits - word.fraction_bits());
    a.label("done");
    a.end();
    return a.finish();
}

MicroProgram source_place_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    const Format mantissa(1, f.word_bits + 11);
    Assembler a("source place", setting.datapath, setting.numbers.rounding);
    std::array<RegisterIndex, 3> s{};
    for (std::size_t i = 0; i < 3; ++i)
        s[i] = a.reg(std::string("s") + "xyz"[i], mantissa.bits(), mantissa.fraction_bits());
    const RegisterIndex exponent = a.reg("exponent", 8, 0);
    const RegisterIndex by = a.reg("by", 8, 0);
    const RegisterIndex before = a.reg("before", 8, 0);
    const RegisterIndex array = a.constant("array", f.array_exponent, 8, 0);
    const RegisterIndex least = a.reg("least", mantissa.bits(), mantissa.fraction_bits());
    const RegisterIndex one = a.constant("one", 1, 8, 0);
    const RegisterIndex above =
        a.constant("above -1", -(std::int64_t(1) << unsigned(mantissa.fraction_bits())) + 1, mantissa.bits(),
                   mantissa.fraction_bits());
    a.move(before, exponent);
    a.least(least, s[0], s[1]);
    a.least(least, least, s[2]);
    a.jump_less(least, above, "-1");
    a.jump("exponent");
    a.label("-1");  // a message holds it with an exponent that is less by one
    a.add(exponent, exponent, one);
    a.label("exponent");
    a.most(exponent, exponent, array);
    a.subtract(by, before, exponent);
    for (const RegisterIndex component : s) a.scale(component, component, by, 0);
    a.end();
    return a.finish();
}

}  // namespace raycell
