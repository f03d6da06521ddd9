// The program `weft`: reads the command line, runs one command, and turns every failure into one message
// on stderr and the documented exit code.
#include <algorithm>
#include <exception>
#include <iostream>
#include <sstream>

#include "cli/command.h"
#include "cli/environment.h"
#include "cli/interrupt.h"
#include "cli/setup.h"
#include "cli/table.h"
#include "cli/text.h"
#include "core/text.h"
#include "scene/reader.h"

namespace weft::cli {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  weft simulate 1 --time 2                  scene 1 for two seconds, one line of results\n"
    "  weft simulate 4 --device cpu --precision f64 --time 1 --out state.csv\n"
    "  weft render 5 --out drop.mp4              a video of scene 5\n"
    "  weft plan 1 --format json                 what would run, as JSON\n"
    "Exit codes: 0 done, 1 internal failure, 2 usage or a bad scene, 3 no suitable device, 4 diverged,\n"
    "  5 over tolerance, 6 input or output, 77 skipped, 130 interrupted.";

std::vector<std::string_view> command_names() {
  std::vector<std::string_view> names;
  for (const Command* command : commands()) names.push_back(command->name);
  return names;
}

/// Long and short option names of a command, for suggestions.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Refuses what the parser could not place.
void refuse_leftovers(const CLI::App& app, std::string_view command) {
  const std::vector<std::string> left = app.remaining();
  if (left.empty()) return;
  const std::string& word = left.front();
  if (word.size() > 1 && word.front() == '-') {
    const std::vector<std::string> names = option_names(app);
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw error(Exit::usage, "{}: there is no option {}{} (see `weft {} --help`)", command, in_quotes(word),
                suggestion(word, known), command);
  }
  throw error(Exit::usage, "{}: {} is one argument too many (see `weft {} --help`)", command, in_quotes(word),
              command);
}

/// A first word that is no scene but nearly a command is a mistyped command.
void refuse_mistyped_command(const std::string& word, std::span<const std::string_view> names) {
  const std::string_view meant = nearest_name(word, names);
  if (meant.empty()) return;
  try {
    find_scene(word);
  } catch (const Error&) {
    throw error(Exit::usage, "there is no command {}; did you mean {}? (see `weft --help`)", in_quotes(word),
                meant);
  }
}

/// The command line with its command first: whatever does not begin with one is for `view`.
std::vector<std::string> with_command(int count, char** words) {
  std::vector<std::string> arguments(words + std::min(count, 1), words + count);
  const std::vector<std::string_view> names = command_names();
  const auto is_command = [&](const std::string& word) {
    return std::find(names.begin(), names.end(), word) != names.end();
  };
  if (!arguments.empty() && arguments.front() == "help") {  // as people ask elsewhere
    arguments.front() = "--help";
    if (arguments.size() > 1 && is_command(arguments[1])) std::swap(arguments[0], arguments[1]);
  }
  if (!arguments.empty()) {
    const std::string& first = arguments.front();
    if (is_command(first) || first == "--help" || first == "-h" || first == "--version") return arguments;
    refuse_mistyped_command(first, names);
  }
  const auto command = std::find_if(arguments.begin(), arguments.end(), is_command);
  if (command != arguments.end())
    throw error(Exit::usage, "the command comes first: weft {} [SCENE] [OPTIONS]", *command);
  arguments.insert(arguments.begin(), "view");
  return arguments;
}

/// The command line as a shell would take it again; the program by its name alone.
std::string typed(int count, char** words) {
  std::string line = "weft";
  for (int w = 1; w < count; ++w) {
    const std::string word = words[w];
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n\"'$&|;<>()[]{}*?!#~`\\") == std::string::npos;
    line += plain ? ' ' + word : " '" + word + '\'';
  }
  return line;
}

Exit run_command(CLI::App& app, const Options& options) {
  for (const Command* command : commands()) {
    const CLI::App* chosen = app.get_subcommand(std::string(command->name));
    if (!chosen->parsed()) continue;
    refuse_leftovers(*chosen, command->name);
    check_environment();
    if (!command->opens_device) require_known_device(options);
    return command->run(options);
  }
  throw Error(Exit::internal, "no command was chosen");
}

Exit run(int count, char** words) {
  CLI::App app("Weft: real-time cloth on Vulkan compute.", "weft");
  app.set_version_flag("--version", "weft " WEFT_VERSION);
  app.require_subcommand(0, 1);
  app.footer(kFooter);
  Options options;
  options.command_line = typed(count, words);
  for (const Command* command : commands()) {
    CLI::App* sub = app.add_subcommand(std::string(command->name), std::string(command->about));
    sub->allow_extras();
    sub->footer("Examples:\n" + std::string(command->examples));
    command->add_options(*sub, options);
    add_shared_options(*sub, options);
  }
  try {
    std::vector<std::string> arguments = with_command(count, words);
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them last first
    app.parse(arguments);
  } catch (const CLI::ParseError& refusal) {
    if (refusal.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(refusal, text, std::cerr);
      print_result(text.str());
      return Exit::ok;
    }
    throw error(Exit::usage, "{} (see `weft --help`)", refusal.what());
  }
  return run_command(app, options);
}

}  // namespace
}  // namespace weft::cli

int main(int argc, char** argv) {
  using namespace weft;
  try {
    cli::catch_interrupts();
    return static_cast<int>(cli::run(argc, argv));
  } catch (const Error& failure) {
    std::cerr << "weft: " << failure.what() << '\n';
    return static_cast<int>(failure.code());
  } catch (const std::exception& failure) {
    std::cerr << "weft: internal failure: " << failure.what()
              << "; this is a bug of Weft, please report it\n";
  } catch (...) {
    std::cerr << "weft: internal failure of an unknown kind; this is a bug of Weft, please report it\n";
  }
  return static_cast<int>(Exit::internal);
}
