// What the program says of itself and of mistakes: help, version, unknown words, bad values. A mistake of
// the user's is exit 2 with nothing on stdout and one message on stderr.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/process.h"

namespace weft::test {
namespace {

const Arguments kCommands = {"view",  "render",  "simulate", "plan",      "validate",
                             "bench", "devices", "scenes",   "materials", "solvers"};

/// A refused command line says every part, on stderr alone.
void expect_refused(const Arguments& arguments, const std::vector<std::string>& parts, int code = 2,
                    const Environment& changes = {}) {
  const Result result = weft(arguments, changes);
  EXPECT_CODE(result, code);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.rfind("weft: ", 0), 0u) << result.err;
  for (const std::string& part : parts) EXPECT_SAYS(result.err, part);
}

TEST(Usage, HelpListsEveryCommandAndTheExitCodes) {
  const Result result = weft({"--help"});
  EXPECT_CODE(result, 0);
  EXPECT_EQ(result.err, "");
  for (const std::string& command : kCommands) EXPECT_SAYS(result.out, command);
  EXPECT_SAYS(result.out, "Exit codes");
}

TEST(Usage, HelpThatCannotBeWrittenIsInputOutput) {
  for (const char* option : {"--help", "--version"}) {
    const int status =
        std::system((WEFT_PROGRAM " " + std::string(option) + " > /dev/full 2> /dev/null").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 6) << option;
  }
}

TEST(Usage, EveryCommandHelpsWithExamplesAndSharedOptions) {
  for (const std::string& command : kCommands) {
    const Result result = weft({command, "--help"});
    EXPECT_CODE(result, 0);
    EXPECT_SAYS(result.out, "Examples:\n  weft");
    for (const char* option :
         {"--device", "--resolution", "--material", "--solver", "--substeps", "--precision", "--set",
          "--time", "--frame", "--format", "--validation", "--quiet", "--verbose", "--version"})
      EXPECT_SAYS(result.out, option);
  }
}

TEST(Usage, VersionIsOneLineEverywhere) {
  for (const Arguments& arguments : {Arguments{"--version"}, Arguments{"simulate", "--version"}}) {
    const Result result = weft(arguments);
    EXPECT_CODE(result, 0);
    EXPECT_EQ(result.out.rfind("weft ", 0), 0u) << result.out;
    EXPECT_EQ(lines_of(result.out).size(), 1u);
  }
}

TEST(Usage, UnknownWordsSuggestTheNearest) {
  expect_refused({"simulat", "1"}, {"simulat", "did you mean simulate?"});
  expect_refused({"simulate", "1", "--resolutoin", "9"}, {"--resolutoin", "did you mean --resolution?"});
  expect_refused({"simulate", "1", "--format", "jsn"},
                 {"--format", "jsn", "human, json", "did you mean json?"});
  expect_refused({"simulate", "1", "--solver", "leapfrg", "--device", "cpu"},
                 {"--solver is \"leapfrg\"", "did you mean leapfrog"});
  expect_refused({"simulate", "1", "--material", "denin", "--device", "cpu"},
                 {"--material is \"denin\"", "did you mean denim?"});
  expect_refused({"study", "1", "--solvers", "rk5", "--out", "there"}, {"--solvers is \"rk5\"", "rk4"});
  expect_refused({"simulate", "two-cornes", "--device", "cpu"}, {"two-cornes", "two-corners"});
  expect_refused({"simulate", "7"}, {"7", "1"});
}

// docs/cli.md: options that speak of Vulkan are never dropped without a word.
TEST(Usage, OptionsOfVulkanAreRefusedWhereItDoesNotCompute) {
  for (const Arguments& option :
       {Arguments{"--kernel", "texel"}, Arguments{"--validation"}, Arguments{"--force-staging"}})
    for (const char* device : {"cpu", "native"}) {
      Arguments words{"simulate", "1", "--time", "0", "--device", device};
      words.insert(words.end(), option.begin(), option.end());
      expect_refused(words, {option.front(), std::string("--device ") + device, "weft devices"});
    }
  expect_refused({"render", "1", "--time", "0", "--device", "cpu", "--kernel", "texel", "--out", "x.png"},
                 {"--kernel", "--device cpu"});
  expect_refused({"validate", "1", "--device", "native", "--validation"},
                 {"--validation", "--device native"});
  expect_refused({"study", "1", "--device", "native", "--kernel", "texel", "--out", "x"},
                 {"--kernel", "--device native"});
  const Environment no_display{{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  EXPECT_CODE(weft({"view", "1", "--device", "native", "--kernel", "texel"}, no_display), 2);
}

TEST(Usage, HelpIsWhatAHelpOptionGives) {
  EXPECT_EQ(weft({"help"}).out, weft({"--help"}).out);
  EXPECT_EQ(weft({"help", "simulate"}).out, weft({"simulate", "--help"}).out);
  EXPECT_EQ(weft({"help"}).code, 0);
}

TEST(Usage, TheCommandComesFirst) {
  expect_refused({"--device", "cpu", "simulate", "1"}, {"the command comes first", "weft simulate"});
}

TEST(Usage, EveryValueIsCheckedWithItsPlaceRuleAndCure) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"--time", "-1"}, "--time is \"-1\""},
      {{"--time", "nan"}, "--time is \"nan\""},
      {{"--time", "inf"}, "--time is \"inf\""},
      {{"--time", "1s"}, "--time is \"1s\""},
      {{"--time", ""}, "--time"},
      {{"--resolution", "1"}, "2 to 4096"},
      {{"--resolution", "4097"}, "2 to 4096"},
      {{"--resolution", "9.5"}, "--resolution is \"9.5\""},
      {{"--substeps", "-3"}, "auto"},
      {{"--substeps", "many"}, "auto"},
      {{"--frame", "0"}, "--frame is \"0\""},
      {{"--frame", "nan"}, "--frame is \"nan\""},
      {{"--precision", "f16"}, "f32, f32k, f64"},
      {{"--precision", "f32k", "--solver", "xpbd"}, "velocity-verlet"},
      {{"--device", ""}, "--device is empty"},
      {{"--shaders", "/no/such/folder"}, "--shaders"},
      {{"--out", ""}, "--out is empty"},
      {{"--time", "1", "--time", "2"}, "--time"},
      {{"--time"}, "--time"},
      {{"2"}, "one argument too many"},
  };
  for (const auto& [arguments, part] : cases) {
    Arguments all{"simulate", "1"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    expect_refused(all, {part});
  }
}

TEST(Usage, SetErrorsNameTheKey) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"cloth.resolution", "="},
      {"cloth.resolutoin=9", "resolution"},
      {"clothe.resolution=9", "cloth"},
      {"cloth.resolution=1", "2 to 4096"},
      {"material.density=-1", "material.density"},
      {"material.density=nan", "material.density"},
      {"gravity.acceleration=[1,2]", "gravity.acceleration"},
      {"cloth.width=\"wide\"", "cloth.width"},
  };
  for (const auto& [text, part] : cases)
    expect_refused({"simulate", "1", "--device", "cpu", "--set", text}, {"--set", part});
}

TEST(Usage, AQuoteInANameStaysInTheName) {
  expect_refused({"simulate", "1", "--device", "cpu", "--material", "a\"\n[floor]\nheight=9"}, {"weft: "});
}

TEST(Usage, AWishForAnErrorOrATimeStandsAlone) {
  expect_refused({"simulate", "1", "--budget", "4", "--error", "1e-3"}, {"--budget", "--error"});
  expect_refused({"simulate", "1", "--error", "1e-3", "--substeps", "9"}, {"--error", "--substeps"});
  expect_refused({"simulate", "1", "--budget", "4", "--solver", "xpbd"}, {"--budget", "--solver"});
}

// Every command heeds --device, also those that open none: a misspelt one is refused with what there is.
TEST(Usage, AnUnknownDeviceIsRefusedByEveryCommand) {
  for (const Arguments& arguments :
       {Arguments{"plan", "1"}, Arguments{"simulate", "1", "--time", "0"}, Arguments{"validate", "1"},
        Arguments{"bench", "1"}, Arguments{"render", "1", "--time", "0", "--out", "/tmp/never.png"},
        Arguments{"study", "1", "--out", "/tmp/never"}, Arguments{"devices"}, Arguments{"scenes"},
        Arguments{"materials"}, Arguments{"solvers"}}) {
    Arguments words = arguments;
    words.insert(words.end(), {"--device", "nativ"});
    if (has_vulkan())
      expect_refused(words, {"--device is \"nativ\"", "cpu or native", "usable"}, 3);
    else
      EXPECT_CODE(weft(words), 3);
  }
  for (const char* device : {"cpu", "native", "Native"})
    EXPECT_CODE(weft({"plan", "1", "--device", device}), 0);
}

// Whatever command runs: a value that none could use is said, and nobody finds out later.
TEST(Usage, EnvironmentVariablesAreCheckedByEveryCommand) {
  const std::vector<std::pair<Environment, std::vector<std::string>>> cases = {
      {{{"WEFT_THREADS", "0"}}, {"WEFT_THREADS is \"0\"", "1 to 1024", "WEFT_THREADS=1"}},
      {{{"WEFT_THREADS", "many"}}, {"WEFT_THREADS is \"many\"", "1 to 1024"}},
      {{{"WEFT_THREADS", "1025"}}, {"WEFT_THREADS is \"1025\"", "1 to 1024"}},
      {{{"WEFT_THREADS", ""}}, {"WEFT_THREADS is \"\"", "1 to 1024"}},
      {{{"WEFT_VECTOR", ""}}, {"WEFT_VECTOR is \"\"", "plain", "unset"}},
      {{{"WEFT_VECTOR", "AVX3"}}, {"WEFT_VECTOR is \"AVX3\"", "plain", "unset"}},
      {{{"WEFT_KERNEL", "strpi"}}, {"WEFT_KERNEL is \"strpi\"", "did you mean strip?"}},
      {{{"WEFT_FORCE_STAGING", "yes"}}, {"WEFT_FORCE_STAGING is \"yes\"", "a whole number"}},
  };
  for (const auto& [environment, parts] : cases)
    for (const Arguments& arguments : {Arguments{"devices"}, Arguments{"plan", "1"},
                                       Arguments{"validate", "1"}, Arguments{"simulate", "1", "--time", "0"}})
      expect_refused(arguments, parts, 2, environment);
  EXPECT_CODE(weft({"devices"}, {{"WEFT_THREADS", "1024"}, {"WEFT_VECTOR", "PLAIN"}}), 0);
  EXPECT_CODE(weft({"--help"}, {{"WEFT_THREADS", "0"}}), 0);
}

// A mistyped scene is said before a window is asked for.
TEST(Usage, AnUnknownSceneIsExitTwoWithoutADisplay) {
  expect_refused({"view", "nosuchscene"}, {"nosuchscene"});
  expect_refused({"nosuchscene"}, {"nosuchscene"});
}

// Without a display the window cannot open: exit 3 where the viewer is built, else exit 2; both say what to
// run.
TEST(Usage, ViewWithoutAWindowSaysToRender) {
  const Environment no_display{{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  for (const Arguments& arguments : {Arguments{}, Arguments{"view"}, Arguments{"3"}}) {
    const Result result = weft(arguments, no_display);
    EXPECT_TRUE(result.code == 2 || result.code == 3) << result.code << result.err;
    EXPECT_SAYS(result.err, "weft render");
    EXPECT_EQ(result.out, "");
  }
}

TEST(Usage, ACommandThatNeedsASceneSaysSo) {
  for (const char* command : {"simulate", "plan", "render"}) expect_refused({command}, {"no scene is given"});
}

TEST(Usage, NoVulkanDeviceIsExitThreeAndTheCpuStillWorks) {
  const Environment none{{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};
  const Arguments command{"simulate", "1", "--resolution", "5", "--time", "0.05"};
  const Result without = weft(command, none);
  EXPECT_CODE(without, 3);
  EXPECT_EQ(without.out, "");
  EXPECT_SAYS(without.err, "--device native");
  Arguments on_cpu = command;
  on_cpu.insert(on_cpu.end(), {"--device", "CPU"});  // names ignore case
  EXPECT_CODE(weft(on_cpu, none), 0);
  const Result devices = weft({"devices"}, none);
  EXPECT_CODE(devices, 0);
  EXPECT_SAYS(devices.out, "CPU reference");
  EXPECT_SAYS(devices.err, "no Vulkan device");
  for (const char* other : {"validate", "bench", "render"}) {
    const Result refused = weft({other, "1", "--resolution", "5", "--out", "x.png"}, none);
    EXPECT_NE(refused.code, 0) << other;
  }
}

TEST(Usage, AnUnknownDeviceIsExitThreeAndNamesThoseThereAre) {
  NEEDS_VULKAN();
  expect_refused({"simulate", "1", "--device", "no such device"}, {"no such device", "0"}, 3);
  expect_refused({"simulate", "1", "--device", "97"}, {"97"}, 3);
}

// The switch lets every device lack float64, so that none can be named.
TEST(Usage, DoubleOnADeviceWithoutItIsExitThreeAndSaysWhichDevicesHaveIt) {
  NEEDS_VULKAN();
  for (const char* command : {"simulate", "bench", "validate"})
    expect_refused({command, "1", "--resolution", "8", "--precision", "f64", "--device", "0", "-q"},
                   {"f64", "no device here has it", "--device cpu"}, 3, {{"WEFT_WITHOUT_FLOAT64", "1"}});
}

}  // namespace
}  // namespace weft::test
