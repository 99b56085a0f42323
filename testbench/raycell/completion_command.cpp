// raycell completion: what a shell needs to complete the words of raycell.
#include <iostream>
#include <sstream>

#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

/// The words that an option takes, if it is one of some: "half quadrant split shared".
std::string words_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (type.find('|') == std::string::npos) return "";
    std::string words = type.substr(type.rfind(':') == std::string::npos ? 0 : type.rfind(':') + 1);
    for (char& c : words) {
        if (c == '|') c = ' ';
    }
    return words;
}

void print_script(const CLI::App& program) {
    std::ostringstream commands;
    std::ostringstream options;
    std::ostringstream values;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
        const std::string name = command->get_name();
        commands << ' ' << name;
        // A sweep takes the options of a run besides its own.
        const CLI::App* also = name == "sweep" ? program.get_subcommand("render") : nullptr;
        options << "        " << name << ") options='";
        for (const CLI::App* each : {command, also}) {
            if (!each) continue;
            for (const CLI::Option* option : each->get_options()) {
                for (const std::string& known : option->get_lnames()) options << " --" << known;
                const std::string words = words_of(*option);
                if (words.empty() || option->get_lnames().empty()) continue;
                values << "        '" << name << " --" << option->get_lnames().front() << "') words='"
                       << words << "' ;;\n";
            }
        }
        options << "' ;;\n";
    }
    std::cout << "# Completion for bash; in zsh, after: autoload -U +X bashcompinit && bashcompinit\n"
                 "_raycell() {\n"
                 "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} "
                 "command=${COMP_WORDS[1]}\n"
                 "    local options='' words=''\n"
                 "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
                 "        COMPREPLY=($(compgen -W '"
              << commands.str() << " --help --version' -- \"$word\"))\n        return\n    fi\n"
              << "    case \"$command $before\" in\n"
              << values.str() << "    esac\n    case \"$command\" in\n"
              << options.str()
              << "    esac\n"
                 "    if [ -n \"$words\" ]; then COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
                 "    elif [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
                 "    else COMPREPLY=($(compgen -f -- \"$word\")); fi\n"
                 "}\n"
                 "complete -o filenames -F _raycell raycell\n";
}

}  // namespace

Command add_completion_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("completion",
                                           "Prints a script that completes raycell's words: "
                                           "source <(raycell completion)");
    return {app, [&program] {
                print_script(program);
                return int(exit_done);
            }};
}

}  // namespace raycell
