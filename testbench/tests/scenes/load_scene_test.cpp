#include "scenes/load_scene.hpp"

#include <unistd.h>

#include <cstdlib>

#include "scene_checks.hpp"

namespace raycell {
namespace {

const std::string view = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 64\n";
const std::string ball = "f 1 0.5 0.2 0.7 0.3 20 0 1\ns 0 0 0 1\n";

std::string error_of(const std::filesystem::path& path, std::optional<std::filesystem::path> view_file = {}) {
    Diagnostics diagnostics;
    try {
        load_scene(path, view_file, diagnostics);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(LoadScene, ChoosesTheReaderByTheExtensionInAnyCase) {
    const Folder folder;
    Diagnostics diagnostics;
    EXPECT_EQ(load_scene(folder.write("a.NFF", view + "l 1 1 1\n" + ball), {}, diagnostics).name, "a.NFF");
    EXPECT_EQ(diagnostics.messages().size(), 0u);
    const Scene obj =
        load_scene(folder.write("b.Obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {}, diagnostics);
    EXPECT_EQ(obj.name, "b.Obj");
    EXPECT_TRUE(obj.view);
    EXPECT_EQ(diagnostics.warning_count(), 0u);
    EXPECT_NE(error_of(folder.write("c.stl", "solid")).find(".nff or .obj"), std::string::npos);
    EXPECT_NE(error_of(folder.write("nff", view)).find(".nff or .obj"), std::string::npos);
}

TEST(LoadScene, RejectsWhatIsNoReadableFile) {
    const Folder folder;
    EXPECT_NE(error_of(folder.path() / "none.nff").find("no such file"), std::string::npos);
    EXPECT_NE(error_of(folder.path()).find("is a directory"), std::string::npos);
    std::filesystem::create_directories(folder.path() / "dir.obj");
    EXPECT_NE(error_of(folder.path() / "dir.obj").find("is a directory"), std::string::npos);
    std::filesystem::create_symlink("/dev/zero", folder.path() / "zero.nff");
    EXPECT_NE(error_of(folder.path() / "zero.nff").find("device"), std::string::npos);
    EXPECT_NE(error_of(folder.path() / "a\nb.nff").find("a\\x0ab.nff"), std::string::npos);
    EXPECT_NE(error_of(folder.write("a.nff", view) / "b.nff"), "");
    EXPECT_NE(error_of(""), "");
}

/// Root may read every file, so while one of these lives, root acts as the user nobody.
class NotRoot {
  public:
    NotRoot() {
        constexpr uid_t nobody = 65534;
        if (was_ == 0) {
            EXPECT_EQ(seteuid(nobody), 0);
        }
    }
    ~NotRoot() { EXPECT_EQ(seteuid(was_), 0); }

  private:
    const uid_t was_ = geteuid();
};

TEST(LoadScene, RejectsAFileWithoutThePermissionToRead) {
    using std::filesystem::perms;
    const Folder folder;
    const auto everybody =
        perms::owner_all | perms::group_read | perms::group_exec | perms::others_read | perms::others_exec;
    std::filesystem::permissions(folder.path(), everybody);
    const auto readable = folder.write("b.nff", view + ball);
    std::filesystem::permissions(readable, everybody);
    const auto path = folder.write("a.nff", view + ball);
    std::filesystem::permissions(path, perms::none);
    const NotRoot not_root;
    EXPECT_EQ(error_of(readable), "") << "what stands in the way is the file alone";
    EXPECT_NE(error_of(path).find("can't be opened"), std::string::npos);
}

TEST(LoadScene, RejectsAnNffSceneWithoutViewUnlessOneIsGiven) {
    const Folder folder;
    const auto scene = folder.write("a.nff", "l 1 1 1\n" + ball);
    EXPECT_NE(error_of(scene).find("has no view"), std::string::npos);
    Diagnostics diagnostics;
    const Scene s = load_scene(scene, folder.write("view.nff", "b 0 0 1\n" + view), diagnostics);
    EXPECT_EQ(s.view->from.z, 5);
    EXPECT_EQ(s.background.z, 1);
    EXPECT_EQ(s.sources.size(), 1u) << "the view file has no source, so the scene keeps its own";
    EXPECT_EQ(all_messages(diagnostics), "");
}

TEST(LoadScene, TakesOnlyViewBackgroundAndSourcesFromAViewFile) {
    const Folder folder;
    Diagnostics diagnostics;
    const auto obj = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scene s = load_scene(obj, folder.write("v.nff", view + "l 1 2 3\nl 4 5 6\n" + ball), diagnostics);
    EXPECT_EQ(s.primitives.size(), 1u);
    EXPECT_EQ(s.sources.size(), 2u);
    EXPECT_EQ(s.view->from.z, 5);
    EXPECT_EQ(all_messages(diagnostics), "");
}

TEST(LoadScene, RejectsAViewFileWithoutViewOrOfAnotherKind) {
    const Folder folder;
    const auto obj = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_NE(error_of(obj, folder.write("v.nff", "b 0 0 0\nl 1 1 1\n")).find("v.nff:2: "),
              std::string::npos);
    EXPECT_NE(error_of(obj, obj).find("OBJ file has no view"), std::string::npos);
    EXPECT_NE(error_of(obj, folder.path() / "none.nff").find("no such file"), std::string::npos);
}

TEST(LoadScene, WarnsOfScenesWithoutObjectsOrSources) {
    const Folder folder;
    Diagnostics no_objects, no_sources;
    load_scene(folder.write("a.nff", view + "l 1 1 1\n"), {}, no_objects);
    EXPECT_EQ(no_objects.count_of("no primitives"), 1u);
    EXPECT_EQ(no_objects.warning_count(), 1u);
    load_scene(folder.write("b.nff", view + ball), {}, no_sources);
    EXPECT_EQ(no_sources.count_of("no sources"), 1u);
    EXPECT_EQ(no_sources.warning_count(), 1u);
}

TEST(LoadScene, ReadsTheProjectsOwnScenesWithoutAWarning) {
    std::size_t scenes = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(RAYCELL_SOURCE_DIR) / "scenes")) {
        if (entry.path().extension() != ".nff") continue;
        ++scenes;
        Diagnostics diagnostics;
        const Scene scene = load_scene(entry.path(), {}, diagnostics);
        EXPECT_EQ(all_messages(diagnostics), "");
        expect_sound(scene);
        EXPECT_FALSE(scene.sources.empty()) << entry.path();
    }
    EXPECT_GE(scenes, 3u);
}

TEST(OwnScenes, StillLifeIsWhatItsScriptWrites) {
    if (!std::filesystem::exists("/usr/bin/python3")) GTEST_SKIP() << "/usr/bin/python3 is missing";
    const std::filesystem::path root = RAYCELL_SOURCE_DIR;
    const Folder folder;
    const std::string command =
        "'" + (root / "scripts/make_still_life").string() + "' '" + (folder.path() / "s.nff").string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto text = [](const std::filesystem::path& path) {
        std::ifstream in(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_TRUE(text(folder.path() / "s.nff") == text(root / "scenes/still_life.nff"));
}

TEST(Printable, EscapesAndCutsWhateverItIsGiven) {
    EXPECT_EQ(printable("abc"), "abc");
    EXPECT_EQ(printable(std::string("a\0\x1b[31m", 7)), "a\\x00\\x1b[31m");
    EXPECT_EQ(printable(std::string(100, 'x')), std::string(40, 'x') + "...");
    EXPECT_EQ(printable("\xc3\xa9", 4), "\\xc3...");
}

}  // namespace
}  // namespace raycell
