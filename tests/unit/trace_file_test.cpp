// SPDX-License-Identifier: Apache-2.0
// The binary form of a trace: what is written is read, what is damaged is refused, what is cut short is kept.
#include "runtime/trace/trace_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "runtime/trace/chrome.hpp"

namespace moraine::runtime {
namespace {

TraceLists sample(std::uint32_t epoch) {
  TraceLists lists;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    TaskRecord t;
    t.start = epoch + i * 1e-3;
    t.end = t.start + 1e-4;
    t.epoch = epoch;
    t.sub_model = i % 7;
    t.worker = static_cast<std::int16_t>(i % 2);
    t.counters = {i, 2, 3, 4};
    t.release = Release::message;
    lists.tasks.push_back(t);
  }
  lists.phases.push_back({double(epoch), epoch + 0.5, epoch, 0, Phase::settle});
  lists.epochs.push_back({epoch * 8, 8, epoch});
  lists.messages.push_back({epoch, 1, 2, 3, 0, 8, 800});
  return lists;
}

class TraceFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / (std::string("moraine_trace_") + info->name());
    settings_.title = "heap \"of\" grains";
    settings_.threads = {2, 3};
    settings_.stages = {"step", "tell"};
    settings_.to = 9;
  }
  void TearDown() override { std::filesystem::remove(path_); }

  void write(bool finish) {
    TraceWriter writer(path_, settings_);
    for (const std::uint32_t epoch : {1U, 0U}) writer.append(pack(sample(epoch)));
    if (finish) writer.finish();
  }
  std::string refusal() const {
    try {
      read_trace_file(path_);
    } catch (const TraceError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path path_;
  TraceSettings settings_;
};

TEST_F(TraceFile, IsReadAsItWasWritten) {
  write(true);
  const Trace trace = read_trace_file(path_);
  EXPECT_TRUE(trace.complete);
  EXPECT_EQ(trace.settings.title, settings_.title);
  EXPECT_EQ(trace.settings.threads, settings_.threads);
  EXPECT_EQ(trace.settings.to, 9);
  ASSERT_EQ(trace.lists.tasks.size(), 2000U);
  const TaskRecord& second = trace.lists.tasks[1];
  EXPECT_EQ(second.start, 2e-3) << "by worker, then by start";
  EXPECT_EQ(second.counters, (std::array<std::uint32_t, 4>{2, 2, 3, 4}));
  EXPECT_EQ(second.release, Release::message);
  EXPECT_EQ(trace.lists.epochs.at(1).first_round, 8);
  EXPECT_EQ(trace.lists.messages.at(1).bytes, 800U);
  EXPECT_LT(std::filesystem::file_size(path_), 2000 * sizeof(TaskRecord) / 3) << "compact";
}

TEST_F(TraceFile, IsKeptAsFarAsItGoes) {
  write(false);
  const auto whole = std::filesystem::file_size(path_);
  Trace trace = read_trace_file(path_);
  EXPECT_FALSE(trace.complete);
  EXPECT_EQ(trace.lists.tasks.size(), 2000U);
  std::filesystem::resize_file(path_, whole - 10);
  trace = read_trace_file(path_);
  EXPECT_FALSE(trace.complete);
  EXPECT_EQ(trace.lists.tasks.size(), 1000U);
}

TEST_F(TraceFile, GoesOnIfTheRunDoes) {
  TraceWriter writer(path_, settings_);
  for (const std::uint32_t epoch : {0U, 1U}) {
    writer.append(pack(sample(epoch)));
    EXPECT_FALSE(read_trace_file(path_).complete) << epoch;
    writer.finish();
    const Trace trace = read_trace_file(path_);
    EXPECT_TRUE(trace.complete) << epoch;
    EXPECT_EQ(trace.lists.epochs.size(), epoch + 1);
  }
}

TEST_F(TraceFile, AsJsonReportsAFullDisk) {
  write(true);
  const Trace trace = read_trace_file(path_);
  try {
    write_chrome(trace, "/dev/full");
    FAIL() << "expected an error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/dev/full: cannot write the trace");
  }
}

TEST_F(TraceFile, IsRefusedIfDamaged) {
  write(true);
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(2000);
  file.put('\x55');
  file.close();
  EXPECT_NE(refusal().find("checksum"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find(path_.string()), std::string::npos);
}

TEST_F(TraceFile, IsRefusedIfItIsSomethingElse) {
  EXPECT_NE(refusal().find("cannot be read"), std::string::npos);
  std::ofstream(path_) << "a letter to someone, long enough";
  EXPECT_NE(refusal().find("is not a trace"), std::string::npos);
  write(true);
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(8);
  file.put('\x01');
  file.close();
  EXPECT_NE(refusal().find("version 1, expected version 2"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace moraine::runtime
