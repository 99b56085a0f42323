#include "testbench/common/configuration.hpp"

#include <toml++/toml.h>

#include <fstream>
#include <sstream>

#include "model/files/input_file.hpp"
#include "testbench/common/options.hpp"

namespace raycell {
namespace {

class Reader {
  public:
    Reader(const std::string& path, std::string text, const CLI::App& app, const CLI::App* other)
        : path_(path), text_(std::move(text)), app_(app), other_(other) {}

    std::vector<std::string> arguments() {
        for (const auto& [key, node] : parse()) option(std::string(key.str()), node);
        return std::move(arguments_);
    }

  private:
    toml::table parse() const {
        try {
            return toml::parse(text_);
        } catch (const toml::parse_error& error) {
            fail(error.source(), printable(error.description(), 120) + "; expected TOML");
        }
    }

    [[noreturn]] void fail(const toml::source_region& where, const std::string& what) const {
        throw UsageError(path_ + ":" + std::to_string(where.begin.line) + ": " + what);
    }

    void option(const std::string& key, const toml::node& node) {
        const bool word = key.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos;
        const CLI::Option* known = word ? app_.get_option_no_throw("--" + key) : nullptr;
        if (!known && word && other_ && other_->get_option_no_throw("--" + key)) return;
        if (!known || key == "config" || key == "preset" || key == "help") {
            fail(node.source(), "unknown key '" + printable(key) + "'; keys are the options of '" +
                                    app_.get_name() + "' without their dashes, see --help");
        }
        const bool flag = known->get_items_expected_max() == 0;
        const bool several = known->get_items_expected_max() > 1;
        if (flag != node.is_boolean()) {
            fail(node.source(),
                 "key '" + key + "': expected " + (flag ? "true or false" : "a number or a word"));
        }
        if (const toml::array* list = node.as_array()) {
            if (!several) fail(node.source(), "key '" + key + "': expected one value, not a list");
            for (const toml::node& item : *list) add(key, item);
        } else {
            add(key, node);
        }
    }

    void add(const std::string& key, const toml::node& node) {
        std::string word;
        if (const auto text = node.value_exact<std::string>()) {
            word = *text;
            // An empty string is the default of file names. For other options it is an error, which the
            // option's own check finds.
            if (word.empty() && (key == "view" || key == "sources" || key == "scene" || key == "frames" ||
                                 key == "save-array" || key == "load-array"))
                return;
        } else if (const auto whole = node.value_exact<std::int64_t>()) {
            word = std::to_string(*whole);
        } else if (const auto truth = node.value_exact<bool>()) {
            word = *truth ? "true" : "false";
        } else if (const auto real = node.value_exact<double>()) {
            char digits[64];
            word.assign(digits, std::to_chars(digits, digits + sizeof digits, *real).ptr);
        } else {
            fail(node.source(), "key '" + key + "': expected a number or a word");
        }
        arguments_.push_back("--" + key + "=" + word);
    }

    std::string path_;
    std::string text_;
    const CLI::App& app_;
    const CLI::App* other_;
    std::vector<std::string> arguments_;
};

}  // namespace

std::optional<std::string> last_word_of(const std::vector<std::string>& words, const std::string& option,
                                        const std::string& value) {
    const std::string name = "--" + option;
    std::optional<std::string> last;
    for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i].rfind(name + "=", 0) == 0) last = words[i].substr(name.size() + 1);
        if (words[i] == name) {
            if (i + 1 == words.size()) throw UsageError(name + ": expected " + value);
            last = words[i + 1];
        }
    }
    return last;
}

std::string configuration_named(const std::vector<std::string>& words) {
    return last_word_of(words, "config", "a file").value_or("");
}

std::vector<std::string> arguments_from_file(const std::string& path, const CLI::App& app,
                                             const CLI::App* other) {
    const std::string fault = input_fault(path);
    if (!fault.empty()) throw UsageError(path + ": " + fault + "; expected a configuration file");
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return arguments_from_text(text.str(), path, app, other);
}

std::vector<std::string> arguments_from_render_file(const std::string& path, const CLI::App& app) {
    RenderOptions ignored;
    CLI::App render;
    OptionTable table(render);
    add_render_options(table, ignored);
    return arguments_from_file(path, app, &render);
}

std::vector<std::string> arguments_from_text(const std::string& text, const std::string& name,
                                             const CLI::App& app, const CLI::App* other) {
    return Reader(name, text, app, other).arguments();
}

std::string to_toml(const nlohmann::ordered_json& values) {
    std::string text;
    // JSON's strings, numbers and lists are valid TOML.
    for (const auto& [key, value] : values.items()) {
        text += key + " = " + value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    }
    return text;
}

}  // namespace raycell
