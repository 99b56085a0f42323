// The script of loading: which call follows which.
#include "testbench/cell/load_calls.hpp"

namespace raycell {
namespace {

constexpr int most_edges = 4;
constexpr std::size_t line_words = LoadCalls::table_stride();  // where the voxel stands, the largest far

std::string numbered(const char* name, int i) { return std::string(name) + " " + std::to_string(i); }

}  // namespace

void LoadCalls::write_messages() {
    script_.label("begin");
    for (const char* name :
         {"voxels end", "edges end", "table end", "lines end", "next number", "next object"})
        script_.set(name, 0);
    script_.rewind();
    script_.end();
    script_.label("message");
    for (const char* name : {"made", "lines", "ends"}) script_.set(name, 0);
    script_.take("type", 1);
    script_.jump_is("type", 5, "span");
    script_.jump_is("type", 1, "features");
    script_.jump_is("type", 0, "setup");
    script_.jump_is("type", 6, "ignored");
    script_.fail();  // sources with kinds, or no message of a cell
    script_.label("features");
    script_.add("next object", "next object", 1);
    script_.take("cx", 10);
    script_.call("shine");
    script_.set("mirror", 0);
    script_.jump_is("mirrors", 0, "object");
    script_.move("mirror", "ks");
    script_.label("object");
    script_.write(LoadPort::objects, object_);
    script_.label("ignored");
    script_.end();
    script_.label("setup");
    script_.take("sources", 1);
    script_.set("source", 0);
    script_.label("next source");
    script_.jump_equal("source", "sources", "ignored");
    script_.take("sx", 7);
    script_.call("source place");
    script_.write(LoadPort::sources, source_);
    script_.add("source", "source", 1);
    script_.jump("next source");
}

void LoadCalls::write_span() {
    script_.label("span");
    script_.take("polygon", 3);
    script_.take("column", 1);
    script_.jump_equal("x", "column", "here");
    script_.end();
    script_.label("here");
    script_.take("axis", 16);
    for (int i = 0; i < most_edges; ++i) {
        script_.jump_is("edges", std::size_t(i), "edges taken");
        script_.take(numbered("edge a", i), 3);
    }
    script_.label("edges taken");
    script_.set("drop x", 0);
    script_.set("drop z", 0);
    script_.jump_is("axis", 1, "voxel");
    script_.jump_is("axis", 2, "z is dropped");
    script_.set("drop x", 1);
    script_.jump("voxel");
    script_.label("z is dropped");
    script_.set("drop z", 1);
    script_.label("voxel");
    script_.call("voxel");
    script_.jump_is("made", 0, "advance");
    script_.jump_is("next number", 0, "new");
    script_.jump_equal("polygon", "voxel polygon", "join");
}

/// A voxel of its own, and what it has in common with one that another piece has joined.
void LoadCalls::write_voxel() {
    script_.label("new");
    script_.copy("voxel near", "piece near", 19);
    script_.move("voxel number", "next number");
    script_.add("next number", "next number", 1);
    script_.move("voxel polygon", "polygon");
    script_.add("voxel object", "next object", -1);
    script_.move("voxel drop x", "drop x");
    script_.move("voxel drop z", "drop z");
    script_.move("voxel edges", "crossings");
    script_.move("voxel first", "edges end");
    script_.set("voxel pieces", 0);
    script_.jump_is("crossings", 0, "covers");
    script_.set("voxel pieces", 1);
    script_.label("covers");
    script_.set("edge piece", 0);
    script_.set("edge way", 0);
    script_.move("voxel place", "voxels end");
    script_.add("voxels end", "voxels end", std::int64_t(voxel_stride()));
    script_.add("lines end", "lines end", std::int64_t(line_stride()));
    script_.move("place", "table end");
    script_.add("table end", "table end", line_words);
    script_.set("lines", 1);
    script_.label("append");
    for (int i = 0; i < most_edges; ++i) {
        const std::string stays = numbered("stays", i);
        script_.jump_is("crossings", std::size_t(i), "appended");
        script_.copy("edge a", numbered("kept a", i), edge_stride() - 1);
        script_.jump_is("edge way", 0, stays);
        script_.call("move edge");
        script_.label(stays);
        script_.put(LoadMemory::edges, "edges end", "edge a", edge_stride());
        script_.add("edges end", "edges end", std::int64_t(edge_stride()));
    }
    script_.label("appended");
    script_.call("components");
    script_.put(LoadMemory::voxels, "voxel place", "voxel number", voxel_stride());
    script_.jump("order");
}

void LoadCalls::write_join() {
    script_.label("join");
    script_.call("join");
    script_.call("plane");
    script_.call("normals");
    script_.set("edge way", 0);
    script_.jump_is("drop z", 1, "moved");
    script_.move("edge way", "way");
    script_.jump_is("way", 0, "moved");
    script_.move("at", "voxel first");
    script_.label("next moved");
    script_.jump_equal("at", "edges end", "moved");
    script_.get(LoadMemory::edges, "edge a", "at", edge_stride());
    script_.call("move edge");
    script_.put(LoadMemory::edges, "at", "edge a", edge_stride());
    script_.add("at", "at", std::int64_t(edge_stride()));
    script_.jump("next moved");
    script_.label("moved");
    script_.jump_is("voxel pieces", 0, "covered");
    script_.jump_is("crossings", 0, "all covered");
    script_.move("edge piece", "voxel pieces");
    script_.add("voxel pieces", "voxel pieces", 1);
    script_.sum("voxel edges", "voxel edges", "crossings");
    script_.jump_is("drop z", 1, "find line");
    script_.move("edge way", "piece way");
    script_.jump("find line");
    script_.label("all covered");  // the piece covers the cell
    script_.move("edges end", "voxel first");
    script_.set("voxel edges", 0);
    script_.set("voxel pieces", 0);
    script_.label("covered");
    script_.set("crossings", 0);
    // Its line of the index table; what stands behind it stays there.
    script_.label("find line");
    script_.set("lines", 1);
    script_.add("place", "table end", -std::int64_t(line_words));
    script_.label("behind");
    script_.get(LoadMemory::table, "line voxel", "place", line_words);
    script_.jump_equal("line voxel", "voxel place", "append");
    script_.call("widen");
    script_.put(LoadMemory::table, "place", "line voxel", line_words);
    script_.add("place", "place", -std::int64_t(line_words));
    script_.add("lines", "lines", 1);
    script_.jump("behind");
}

/// Lines that are farther move up.
void LoadCalls::write_order() {
    script_.label("order");
    script_.jump_is("place", 0, "first");
    script_.add("at", "place", -std::int64_t(line_words));
    script_.get(LoadMemory::table, "line voxel", "at", line_words);
    script_.get(LoadMemory::voxels, "line near", "line voxel", 1,
                unit_.field("voxel near") - unit_.field("voxel number"));
    script_.call("order");
    script_.jump_is("before", 0, "stands");
    script_.put(LoadMemory::table, "place", "line voxel", line_words);
    script_.move("place", "at");
    script_.add("lines", "lines", 1);
    script_.jump("order");
    script_.label("stands");
    script_.call("widen");
    script_.jump("line");
    script_.label("first");
    script_.move("line most", "voxel far");
    script_.label("line");
    script_.move("line voxel", "voxel place");
    script_.put(LoadMemory::table, "place", "line voxel", line_words);
}

void LoadCalls::write_advance() {
    script_.label("advance");
    script_.call("advance");
    script_.set("ends", 1);
    script_.jump_is("passes", 0, "sent");
    script_.set("ends", 0);
    script_.send("x", 1);
    script_.send("c", 1);
    script_.send("bx", 3);
    for (int i = 0; i < most_edges; ++i) {
        script_.jump_is("edges", std::size_t(i), "sent");
        script_.send(numbered("edge c", i), 1);
    }
    script_.label("sent");
    script_.end();
}

void LoadCalls::write_finish() {
    script_.label("finish");
    script_.set("at", 0);
    script_.label("next line");
    script_.jump_equal("at", "table end", "lines written");
    script_.get(LoadMemory::table, "line voxel", "at", line_words);
    script_.get(LoadMemory::voxels, "voxel number", "line voxel", voxel_stride());
    script_.sum("voxel first", "voxel first", "lines end");
    script_.write(LoadPort::store, store_);
    script_.add("at", "at", line_words);
    script_.jump("next line");
    script_.label("lines written");
    script_.set("at", 0);
    script_.label("next edge");
    script_.jump_equal("at", "edges end", "edges written");
    script_.get(LoadMemory::edges, "edge a", "at", edge_stride());
    script_.write(LoadPort::store, edge_);
    script_.add("at", "at", std::int64_t(edge_stride()));
    script_.jump("next edge");
    script_.label("edges written");
    script_.set("at", 0);
    script_.label("next voxel");
    script_.jump_equal("at", "voxels end", "written");
    script_.get(LoadMemory::voxels, "voxel number", "at", voxel_stride());
    script_.write(LoadPort::voxels, shading_);
    script_.add("at", "at", std::int64_t(voxel_stride()));
    script_.jump("next voxel");
    script_.label("written");
    script_.end();
}

}  // namespace raycell
