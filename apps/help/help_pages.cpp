#include "apps/help/help_pages.h"

#include <fmt/chrono.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <ostream>

#include "apps/help/command_help.h"
#include "apps/help/completion.h"
#include "apps/help/man_page.h"
#include "host/core/errors.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

/// Returns the date of SOURCE_DATE_EPOCH if it is set, else today (https://reproducible-builds.org).
std::string date_of_pages() {
    std::time_t time = std::time(nullptr);
    if (const char* text = std::getenv("SOURCE_DATE_EPOCH")) {
        const std::string_view digits = text;
        const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), time);
        if (error != std::errc() || stop != digits.data() + digits.size())
            throw UsageError(fmt::format("SOURCE_DATE_EPOCH '{}' is no number of seconds", digits));
    }
    return fmt::format("{:%Y-%m-%d}", fmt::gmtime(time));
}

void write_help_pages(const CommandHelp& program, const std::string& version, const fs::path& folder) {
    const std::string release = program.name() + " " + version, date = date_of_pages();
    for (const CommandHelp* command : all_commands(program))
        write_text(folder / "man1" / (man_page_name(*command) + ".1"), man_page(*command, release, date));
    write_text(folder / "bash" / program.name(), bash_completion(program));
    write_text(folder / "zsh" / ("_" + program.name()), zsh_completion(program));
    write_text(folder / "fish" / (program.name() + ".fish"), fish_completion(program));
}

}  // namespace

void add_help_pages_option(Command& program, const std::string& version) {
    const auto write = [&app = program.app(), version](const std::string& folder) {
        write_help_pages(describe_command(app), version, folder);
        throw CLI::Success();
    };
    program.add_word_option("--help-pages", write, "")->hide();
}

}  // namespace exemplar
