// Programs of loading: a span's way along its row, and what a cell makes of it.
#include "model/microcode/loading.hpp"

#include "model/numbers/fixed.hpp"

namespace raycell {

void LoadingWriter::take_way() {
    x_ = number_of("x", 14);
    last_ = number_of("last", 14);
    passes_ = number("passes");
}

/// The next cell's functions: one addition each. v is y or z, which stay.
void LoadingWriter::advance(HitTest rung, Normals normals) {
    const bool depth = rung == HitTest::depth;
    a_.move(passes_, zero_);
    a_.jump_less(x_, last_, "passes");
    a_.jump("advanced");
    a_.label("passes");
    a_.move(passes_, one_);
    a_.add(x_, x_, one_);
    if (depth) a_.add(z_, z_, dz_);
    for (std::size_t i = 0; depth && normals == Normals::voxel && i < 3; ++i) a_.add(n_[i], n_[i], dn_[i]);
    if (depth && normals == Normals::voxel) {
        a_.label("advanced");
        return;
    }
    a_.jump_zero(drop_x_, "along u");
    if (!depth) {  // the plane's normal is 1 or -1 along x
        a_.jump_zero(negative_, "minus one");
        a_.add(c_, c_, one_length_);
        a_.jump("advanced");
        a_.label("minus one");
        a_.subtract(c_, c_, one_length_);
    }
    a_.jump("advanced");
    a_.label("along u");
    for (std::size_t i = 0; i < 3; ++i) a_.add(base_[i], base_[i], du_[i]);
    if (!depth) {
        a_.subtract(c_, c_, nu_);
        for (std::size_t i = 0; i < 4; ++i) {
            const RegisterIndex number = a_.constant("edge " + std::to_string(i), std::int64_t(i) + 1, 6, 0);
            a_.jump_less(edges_, number, "advanced");
            a_.add(edge_c_ + i, edge_c_ + i, edge_a_ + i);
        }
    }
    a_.label("advanced");
}

namespace {

/// A program that tells in `made` whether the polygon touches the cell.
MicroProgram finish_making(Assembler& a) {
    const RegisterIndex made = a.reg("made", 2, 0);
    const RegisterIndex yes = a.constant("yes", 1, 2, 0);
    const RegisterIndex no = a.constant("no", 0, 2, 0);
    a.move(made, yes);
    a.end();
    a.label("none");
    a.move(made, no);
    a.end();
    return a.finish();
}

}  // namespace

MicroProgram advance_program(const MicroSetting& setting, HitTest rung, Normals normals) {
    Assembler a("advance", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, {});
    writer.take_way();
    if (rung == HitTest::depth) {
        writer.take_depth_span();
    } else {
        writer.take_span();
    }
    writer.take_normals();
    writer.advance(rung, normals);
    a.end();
    return a.finish();
}

MicroProgram forward_program(const MicroSetting& setting) {
    Assembler a("forward", setting.datapath, setting.numbers.rounding);
    const RegisterIndex type = a.reg("type", 4, 0);
    const RegisterIndex x = a.reg("x", 14, 0);
    const RegisterIndex column = a.reg("column", 14, 0);
    const RegisterIndex other = a.reg("other", 15, 0);
    const RegisterIndex makes = a.reg("makes", 2, 0);
    const RegisterIndex span = a.constant("span", 5, 4, 0);
    const RegisterIndex yes = a.constant("1", 1, 2, 0);
    const RegisterIndex no = a.constant("0", 0, 2, 0);
    a.move(makes, no);
    a.subtract(other, type, span);
    a.jump_zero(other, "span");
    a.end();
    a.label("span");
    a.subtract(other, x, column);
    a.jump_zero(other, "makes");
    a.end();
    a.label("makes");
    a.move(makes, yes);
    a.end();
    return a.finish();
}

MicroProgram cut_program(const MicroSetting& setting) {
    Assembler a("cut", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, {});
    writer.take_corners();
    writer.take_line();
    writer.cut();
    a.end();
    return a.finish();
}

void LoadingWriter::centre() {
    const RegisterIndex half = loading_constant("half a cell", 0.5, f_ + 2);
    a_.move(z_low_, z_);
    a_.move(z_high_, z_);
    a_.move(middle_u_, half);
    a_.move(middle_v_, half);
    a_.jump_less(zero_, drop_z_, "centre");
    a_.move(middle_v_, z_);
    a_.label("centre");
}

MicroProgram edge_of_voxel_program(const MicroSetting& setting) {
    Assembler a("edge of voxel", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, {});
    writer.take_span();
    writer.take_line();
    writer.take_run();
    writer.take_edges();
    writer.edge();
    a.end();
    return a.finish();
}

MicroProgram plane_of_voxel_program(const MicroSetting& setting) {
    Assembler a("plane of voxel", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, {});
    writer.take_span();
    writer.take_run();
    writer.take_anchor();
    writer.plane();
    a.end();
    return a.finish();
}

MicroProgram normal_of_voxel_program(const MicroSetting& setting, Normals normals) {
    Assembler a(normals == Normals::linear ? "normals of voxel" : "normal of voxel", setting.datapath,
                setting.numbers.rounding);
    LoadingWriter writer(a, setting, {});
    writer.take_span();
    writer.take_normals();
    writer.take_run();
    writer.take_anchor();
    writer.normal(normals, HitTest::edge);
    a.end();
    return a.finish();
}

MicroProgram levels_program(const MicroSetting& setting, const DepthLevels& levels) {
    Assembler a("levels", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, levels);
    writer.take_span();
    writer.take_measures();
    writer.take_run();
    writer.run(true);
    a.end();
    return a.finish();
}

MicroProgram voxel_program(const MicroSetting& setting, const DepthLevels& levels, HitTest rung,
                           Normals normals) {
    static const char* const names[] = {"voxel depth", "voxel interval", "voxel plane", "voxel mask",
                                        "voxel edge"};
    Assembler a(names[int(rung)], setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, levels);
    const bool depth = rung == HitTest::depth;
    if (depth) {
        writer.take_depth_span();
    } else {
        writer.take_span();
    }
    writer.take_normals();
    writer.take_measures();
    writer.take_run();
    writer.take_anchor();
    if (depth) {
        writer.centre();
        writer.run(false);
    } else {
        writer.take_corners();
        writer.take_line();
        writer.take_edges();
        if (rung == HitTest::mask) writer.take_bounds();
        writer.part();
        writer.run(true);
        writer.cross(rung);
        if (rung == HitTest::mask) writer.mask();
    }
    writer.anchor();
    if (rung == HitTest::interval) writer.slopes();
    if (rung >= HitTest::plane) writer.plane();
    writer.normal(normals, rung);
    return finish_making(a);
}

MicroProgram part_program(const MicroSetting& setting, const DepthLevels& levels) {
    Assembler a("part", setting.datapath, setting.numbers.rounding);
    LoadingWriter writer(a, setting, levels);
    writer.take_span();
    writer.take_corners();
    writer.take_line();
    writer.take_measures();
    writer.part();
    return finish_making(a);
}

}  // namespace raycell
