#include "scenarios/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <stdexcept>

#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

void put(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

std::string refusal(const std::filesystem::path& folder) {
  try {
    OutputFolder{folder};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(OutputFolder, CreatesFoldersThatAreMissing) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b/c"));
  EXPECT_THAT(names_in(scratch / "a/b/c"), UnorderedElementsAre());
}

TEST(OutputFolder, RemovesAnEarlierRunsFilesAndNoOthers) {
  const test::ScratchFolder scratch;
  for (const char* name : {"summary.json", "estimates.csv", "run.lcm", "run.mp4", "scenario.yaml",
                           "run.part.mp4", "notes.txt", "run.mp4.bak"})
    put(scratch / name, "old");
  OutputFolder folder(scratch.path());
  EXPECT_THAT(names_in(scratch.path()), UnorderedElementsAre("notes.txt", "run.mp4.bak"));
}

TEST(OutputFolder, WritesWholeFiles) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  folder.write(kSummaryFile, "{}\n");
  EXPECT_EQ(test::file_text(scratch / "summary.json"), "{}\n");
  EXPECT_THAT(names_in(scratch.path()), UnorderedElementsAre("summary.json"));
}

TEST(OutputFolder, ShowsAFileUnderItsNameOnlyOnceComplete) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  put(folder.part(kVideoFile), "half");
  EXPECT_THAT(names_in(scratch.path()), UnorderedElementsAre("run.part.mp4"));
  folder.complete(kVideoFile);
  EXPECT_THAT(names_in(scratch.path()), UnorderedElementsAre("run.mp4"));
}

TEST(OutputFolder, RemovesPartsThatWereNeverCompleted) {
  const test::ScratchFolder scratch;
  {
    OutputFolder folder(scratch.path());
    put(folder.part(kVideoFile), "half");
    folder.write(kScenarioFile, "seed: 1\n");
  }
  EXPECT_THAT(names_in(scratch.path()), UnorderedElementsAre("scenario.yaml"));
}

TEST(OutputFolder, TakesTheSummaryOnlyAfterEverythingElse) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  put(folder.part(kVideoFile), "half");
  EXPECT_THROW(folder.write(kSummaryFile, "{}\n"), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(scratch / "summary.json"));
  folder.complete(kVideoFile);
  folder.write(kSummaryFile, "{}\n");
  EXPECT_TRUE(std::filesystem::exists(scratch / "summary.json"));
}

TEST(OutputFolder, CannotCompleteAFileThatWasNotWritten) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  EXPECT_THROW(folder.complete(kVideoFile), std::runtime_error);
}

TEST(OutputFolder, RefusesAFileInOneLine) {
  const test::ScratchFolder scratch;
  put(scratch / "taken", "text");
  EXPECT_EQ(refusal(scratch / "taken"),
            "output folder " + (scratch / "taken").string() + ": is a file");
  EXPECT_EQ(test::file_text(scratch / "taken"), "text");
}

TEST(OutputFolder, RefusesAPathThroughAFile) {
  const test::ScratchFolder scratch;
  put(scratch / "taken", "text");
  EXPECT_THAT(refusal(scratch / "taken/below"), HasSubstr("cannot be created"));
}

TEST(OutputFolder, RefusesAFolderThatCannotBeWritten) {
  // Even root creates no files there.
  EXPECT_EQ(refusal("/proc/self"), "output folder /proc/self: cannot be written");
}

TEST(OutputFolder, RefusesAFolderWhoseOldFilesCannotBeRemoved) {
  const test::ScratchFolder scratch;
  std::filesystem::create_directories(scratch / "run.mp4/full");
  EXPECT_THAT(refusal(scratch.path()), HasSubstr("old run.mp4 cannot be removed"));
}

}  // namespace
}  // namespace nightjar::scenarios
