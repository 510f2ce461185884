#include "apps/help/man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <vector>

namespace exemplar {
namespace {

/// Escapes a text, so that hyphens can be copied into a shell and quotes stay straight.
std::string escaped_roff(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '\\':
                out += "\\e";
                break;
            case '-':
                out += "\\-";
                break;
            case '\'':
                out += "\\(aq";
                break;
            case '`':
                out += "\\(ga";
                break;
            case '^':
                out += "\\(ha";
                break;
            case '~':
                out += "\\(ti";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string bold(std::string_view text) {
    return "\\fB" + escaped_roff(text) + "\\fR";
}
std::string italic(std::string_view text) {
    return "\\fI" + escaped_roff(text) + "\\fR";
}

std::vector<std::string> text_lines(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

/// Returns a line of the file; escapes a leading dot or quote, which would be a request.
std::string line_of(std::string_view roff) {
    return (roff.starts_with('.') || roff.starts_with('\'') ? "\\&" : "") + std::string(roff) + "\n";
}

/// Wraps roff text to short lines for editors and checkers; it is filled again when shown.
std::string wrapped(std::string_view roff) {
    constexpr std::size_t k_width = 76;
    std::string out, line;
    while (!roff.empty()) {
        const std::size_t end = std::min(roff.find(' '), roff.size());
        if (!line.empty() && line.size() + 1 + end > k_width) {
            out += line_of(line);
            line.clear();
        }
        if (!line.empty() && end > 0) line += ' ';
        line += roff.substr(0, end);
        roff.remove_prefix(std::min(end + 1, roff.size()));
    }
    return line.empty() ? out : out + line_of(line);
}

/// A footer's text before and after the line that announces examples.
struct Footer {
    std::vector<std::string> text, examples;
};
Footer split_footer(std::string_view footer) {
    Footer parts;
    const std::vector<std::string> lines = text_lines(footer);
    const auto heading = std::ranges::find_if(lines, [](const auto& l) { return l == "Example:" || l == "Examples:"; });
    parts.text.assign(lines.begin(), heading);
    if (heading != lines.end()) parts.examples.assign(std::next(heading), lines.end());
    return parts;
}

/// Joins lines of a footer that were broken only for their width; keeps short and indented lines.
std::string flowing(const std::vector<std::string>& lines) {
    constexpr std::size_t k_broken_for_width = 85;
    std::string out = lines.empty() ? "" : ".PP\n";
    bool in_line = false;
    for (const std::string& line : lines) {
        if (line.empty()) continue;
        if (line.starts_with(' ')) {
            out += ".nf\n" + line_of(escaped_roff(line)) + ".fi\n";
            continue;
        }
        if (!in_line && out != ".PP\n") out += ".br\n";
        out += wrapped(escaped_roff(line));
        in_line = line.size() >= k_broken_for_width && !line.ends_with('.');
    }
    return out;
}

std::string synopsis(const CommandHelp& command) {
    std::string text = bold(command.path) + " [" + italic("OPTION") + "...]";
    if (!command.subcommands.empty()) return text + " " + italic("COMMAND") + " ...";
    for (const ArgumentHelp& argument : command.positionals) {
        const std::string name = italic(argument.names.front()) + (argument.many ? "..." : "");
        text += argument.required ? " " + name : " [" + name + "]";
    }
    return text;
}

std::string heading_of(const ArgumentHelp& argument, bool positional) {
    if (positional) return italic(argument.names.front()) + (argument.many ? "..." : "");
    std::vector<std::string> names;
    for (const std::string& name : argument.names) names.push_back(bold(name));
    std::string text = fmt::format("{}", fmt::join(names, ", "));
    if (!argument.value.empty()) text += " " + italic(argument.value) + (argument.many || argument.comma ? "..." : "");
    return text;
}

/// Returns whether the description already names all words.
bool names_all_words(const ArgumentHelp& argument) {
    return std::ranges::all_of(
        argument.words, [&](const std::string& word) { return argument.description.find(word) != std::string::npos; });
}

/// CLI11 writes lists as [a,b].
std::string without_brackets(const std::string& value) {
    return value.starts_with('[') && value.ends_with(']') ? value.substr(1, value.size() - 2) : value;
}

std::string paragraph_of(const ArgumentHelp& argument, bool positional) {
    std::vector<std::string> remarks;
    if (argument.required && !positional) remarks.emplace_back("required");
    if (!argument.range.empty()) remarks.push_back(argument.range);
    if (!names_all_words(argument)) remarks.push_back(fmt::format("one of: {}", fmt::join(argument.words, ", ")));
    if (!argument.default_value.empty()) remarks.push_back("default: " + without_brackets(argument.default_value));
    std::string text = argument.description;
    if (!remarks.empty()) text += fmt::format(" ({})", fmt::join(remarks, "; "));
    return ".TP\n" + line_of(heading_of(argument, positional)) + wrapped(escaped_roff(text));
}

std::string section(std::string_view title, const std::vector<ArgumentHelp>& arguments, bool positional) {
    if (arguments.empty()) return {};
    std::string out = fmt::format(".SH {}\n", title);
    for (const ArgumentHelp& argument : arguments) out += paragraph_of(argument, positional);
    return out;
}

std::string subcommand_section(const CommandHelp& command) {
    if (command.subcommands.empty()) return {};
    std::string out = ".SH COMMANDS\n";
    for (const CommandHelp& below : command.subcommands)
        out += ".TP\n" + line_of(bold(man_page_name(below)) + "(1)") + wrapped(escaped_roff(below.description));
    return out;
}

std::string example_section(const std::vector<std::string>& lines) {
    if (lines.empty()) return {};
    std::string out = ".SH EXAMPLES\n.EX\n";
    for (const std::string& line : lines)
        if (!line.empty()) out += line_of(escaped_roff(line));
    return out + ".EE\n";
}

/// The program's page names those of its commands in a section of their own; theirs lead back.
std::string see_also(const CommandHelp& command) {
    const std::size_t last = command.path.rfind(' ');
    if (last == std::string::npos) return {};
    std::string out = ".SH SEE ALSO\n", path;
    for (const char c : command.path.substr(0, last) + " ") {
        if (c == ' ') out += line_of(bold(joined_path(path, '-')) + "(1)" + (path.size() < last ? "," : ""));
        path += c;
    }
    return out;
}

}  // namespace

std::string man_page_name(const CommandHelp& command) {
    return joined_path(command.path, '-');
}

std::string man_page(const CommandHelp& command, std::string_view release, std::string_view date) {
    const std::string name = man_page_name(command);
    std::string title = name;
    for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const Footer footer = split_footer(command.footer);
    std::string description = command.description;
    if (description.ends_with('.')) description.pop_back();
    return fmt::format(".TH {} 1 {} \"{}\" \"Exemplar\"\n", escaped_roff(title), date, escaped_roff(release)) +
           ".SH NAME\n" + line_of(escaped_roff(name) + " \\- " + escaped_roff(description)) + ".SH SYNOPSIS\n" +
           wrapped(synopsis(command)) + ".SH DESCRIPTION\n" + wrapped(escaped_roff(description + ".")) +
           flowing(footer.text) + section("ARGUMENTS", command.positionals, true) + subcommand_section(command) +
           section("OPTIONS", command.options, false) + example_section(footer.examples) + see_also(command);
}

}  // namespace exemplar
