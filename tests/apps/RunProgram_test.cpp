// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <process/RunProgram.h>

#include <gtest/gtest.h>
#include <signal.h>

#include <system_error>
#include <vector>

using geofx::ProgramOptions;
using geofx::ProgramResult;
using geofx::runProgram;

TEST(RunProgram, CapturesBothStreamsAndTheExitCode)
{
    ProgramOptions options;
    options.input = "in";
    options.environment = {"GEOFX_TEST_VALUE=with spaces"};
    options.folder = "/";
    const auto result = runProgram({"sh", "-c", "cat; pwd; echo \"$GEOFX_TEST_VALUE\" >&2; exit 3"}, options);
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_FALSE(result.timedOut);
    EXPECT_EQ(result.standardOutput, "in/\n");
    EXPECT_EQ(result.standardError, "with spaces\n");
    EXPECT_EQ(runProgram({"sh", "-c", "kill -SEGV $$"}).exitCode, 128 + SIGSEGV);
    EXPECT_EQ(runProgram({"no-such-program-of-ours"}).exitCode, 127);
    options.seconds = 0.0;
    options.folder.clear();
    options.environment.clear();
    EXPECT_THROW(runProgram({"no-such-program-of-ours"}, options), std::system_error);
}

TEST(RunProgram, EndsAProgramAfterItsTime)
{
    ProgramOptions options;
    options.seconds = 0.2;
    EXPECT_TRUE(runProgram({"sleep", "60"}, options).timedOut);
    options.signal = SIGKILL;
    const auto result = runProgram({"sleep", "60"}, options);
    EXPECT_TRUE(result.timedOut);
    EXPECT_EQ(result.exitCode, 128 + SIGKILL);
}

TEST(RunProgram, TellsWhatAProgramTook)
{
    ProgramOptions options;
    options.seconds = 0.0;
    const ProgramResult result =
        runProgram({"sh", "-c", "i=0; while [ $i -lt 100000 ]; do i=$((i + 1)); done; sleep 0.3"}, options);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_GT(result.seconds, 0.3);
    EXPECT_GT(result.cpuSeconds, 0.0);
    EXPECT_LT(result.cpuSeconds, result.seconds);
    EXPECT_GT(result.peakMiB, 0.1);
}

TEST(RunProgram, HandsOutTheProcessWhileItRuns)
{
    ProgramOptions options;
    options.seconds = 0.0;
    std::vector<pid_t> seen;
    options.runs = [&](pid_t child)
    {
        seen.push_back(child);
        if (child > 0) kill(child, SIGTERM);
    };
    EXPECT_EQ(runProgram({"sleep", "60"}, options).exitCode, 128 + SIGTERM);
    ASSERT_EQ(seen.size(), 2u);
    EXPECT_GT(seen[0], 0);
    EXPECT_EQ(seen[1], 0);
}
