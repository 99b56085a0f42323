// Mutated scenes: a reader may refuse them, but only with an InputError; what it accepts keeps every promise
// of a scene.
#include <cstdlib>
#include <random>

#include "scene_checks.hpp"

namespace raycell {
namespace {

const std::string nff =
    "b 0.1 0.2 0.3\nv\nfrom 1 2 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 64\n"
    "l 5 5 5\nl -5 5 5 1 0.5 0\n# comment\nf 1 0.5 0.2 0.7 0.3 20 0.5 1.5\ns 0 0 0 1\nc\n0 0 0 2\n0 0 1 1\n"
    "p 4\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\npp 4\n-1 -1 0 0 0 1\n1 -1 0 0 0 1\n1 1 0.5 0 1 1\n-1 1 0 0 0 1\n"
    "f 0.1 0.2 0.3 0.4 0.5 6 0 0\np 5\n0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\ns 1e-3 2.5E+2 -.5 -1\n";

const std::string obj =
    "mtllib m.mtl other.mtl\no thing\nv -1 -1 0\nv 1 -1 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv -1 1 0\nv 0 0 1\n"
    "vt 0 0\nvn 0 0 1\nvn 0.5 0 0.5\nusemtl m\nf 1 2 3 4\nf 1/1/1 2/1/2 5/1/1\nf -1//-1 -2//-1 \\\n-3//-2\n"
    "usemtl other\ng a b\nf 1/1 2/1 5/1\nl 1 2\ns 1\nf 1 2 5\nf 2 3 5\ns off\nf 3// 4// 5//\nf 1 2\ngroup x\n"
    "usemap b\n\x1a";

const std::string mtl =
    "newmtl m\nKd 0.5 0.6 0.7\nKs 1 1 1\nNs 100\nNi 1.5\nd 0.3\nTr 0.7\nTf 0.1 0.1 0.1\nillum 7\nmap_Kd "
    "a.png\n"
    "newmtl other\nKd 1 0 0\nillum 2\nKe 1 1 1\nKa 0 0 0\nbump b.png\nPm 1\nnonsense 3\n\x1a";

/// Words that are likely to matter somewhere in a scene.
const std::string pieces[] = {"nan",
                              "inf",
                              "-1",
                              "0",
                              "1e400",
                              "1e300",
                              "1e30",
                              "-1e30",
                              "1e-320",
                              "2000000000",
                              "\n",
                              "\r",
                              "\r\n",
                              " ",
                              "#",
                              "\\\n",
                              std::string(1, '\0'),
                              "\xef\xbb\xbf",
                              "p",
                              "pp",
                              "s",
                              "c",
                              "f",
                              "v",
                              "l",
                              "b",
                              "from",
                              "/",
                              "//",
                              "usemtl",
                              "newmtl",
                              "mtllib m.mtl\n",
                              "\x1a",
                              "s 1\n",
                              "s",
                              "vn",
                              "1//",
                              "1/1/1/1",
                              "Ke",
                              "-9",
                              "3",
                              "p 3",
                              "0x1",
                              "+",
                              "e",
                              "."};

std::string mutate(std::string text, std::mt19937_64& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const std::size_t changes = 1 + below(4);
    for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
        const std::size_t at = below(text.size());
        const std::size_t length = 1 + below(std::min<std::size_t>(text.size() - at, 20));
        switch (below(7)) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(below(text.size()), length));
                break;
            case 3:
                text.resize(at);
                break;
            case 4:
                text.insert(at, pieces[below(std::size(pieces))]);
                break;
            default: {  // replaces a word
                const std::size_t from = std::min(text.find_last_of(" \n", at) + 1, text.size());
                const std::size_t to = std::min(text.find_first_of(" \n", from), text.size());
                text.replace(from, to - from, pieces[below(std::size(pieces))]);
            }
        }
    }
    return text;
}

/// The seed. To set another: RAYCELL_FUZZ_SEED=N scenes_tests --gtest_filter='Fuzz*'
std::uint64_t seed() {
    const char* given = std::getenv("RAYCELL_FUZZ_SEED");
    return given ? std::strtoull(given, nullptr, 10) : 1990;
}

template <typename Read>
void fuzz(const std::string& good, int mutations, const Read& read, bool refuses = true) {
    std::cout << "seed " << seed() << " (RAYCELL_FUZZ_SEED)\n";
    int accepted = 0;
    for (int i = 0; i < mutations; ++i) {
        std::mt19937_64 random(seed() + static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL);
        const std::string text = mutate(good, random);
        Diagnostics diagnostics;
        try {
            const Scene scene = read(text, diagnostics);
            ++accepted;
            expect_sound(scene);
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_LT(message.size(), 400u);
            for (const char c : message) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << message;
        }
        EXPECT_LT(diagnostics.messages().size(), 150u);
        for (const std::string& message : diagnostics.messages()) {
            for (const char c : message) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << message;
        }
        ASSERT_FALSE(::testing::Test::HasFailure()) << "mutation " << i << " of seed " << seed() << ":\n"
                                                    << text;
    }
    EXPECT_GT(accepted, 0) << "mutations are too wild to test anything";
    if (refuses) {
        EXPECT_LT(accepted, mutations);
    } else {
        EXPECT_EQ(accepted, mutations);
    }
}

TEST(Fuzz, MutatedNffIsRefusedOrSound) {
    fuzz(nff, 6000, [](const std::string& text, Diagnostics& diagnostics) {
        return read_nff_text(text, "t", diagnostics);
    });
}

TEST(Fuzz, MutatedObjIsRefusedOrSound) {
    const Folder folder;
    folder.write("m.mtl", mtl);
    fuzz(obj, 3000, [&](const std::string& text, Diagnostics& diagnostics) {
        Scene scene = read_obj_text(text, "t", folder.path(), diagnostics);
        add_default_view(scene, diagnostics);
        return scene;
    });
}

TEST(Fuzz, MutatedMtlIsNeverRefusedAndSound) {
    const Folder folder;
    const auto read = [&](const std::string& text, Diagnostics& diagnostics) {
        folder.write("m.mtl", text);
        return read_obj_text(obj, "t", folder.path(), diagnostics);
    };
    fuzz(mtl, 1500, read, false);
}

}  // namespace
}  // namespace raycell
