// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Machine.h"

#include <osgGeoFX/offscreen/EglGraphicsContext.h>

#include <ctime>
#include <malloc.h>
#include <unistd.h>

#include <fstream>
#include <thread>

namespace geofx::bench
{

namespace
{

std::string processorName()
{
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
    {
        const std::size_t colon = line.find(": ");
        if (line.compare(0, 10, "model name") == 0 && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    return "unknown processor";
}

} // namespace

Machine Machine::describe()
{
    Machine machine;
    machine.processor = processorName();
    machine.processors = std::thread::hardware_concurrency();
    machine.memoryMiB = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) / (1024u * 1024u);

    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = traits->height = 16;
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (context->valid() && context->realize() && context->makeCurrent())
    {
        machine.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        machine.glVersion = reinterpret_cast<const char*>(glGetString(GL_VERSION));
        context->releaseContext();
        context->close();
    }
    else
    {
        machine.renderer = "no OpenGL (" + context->error() + ")";
        machine.glVersion = "none";
    }
    return machine;
}

double residentMiB()
{
    std::ifstream file("/proc/self/statm");
    double size = 0.0, resident = 0.0;
    file >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

double allocatedMiB()
{
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd) / 1048576.0;
}

namespace
{

double secondsOf(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

double processSeconds()
{
    return secondsOf(CLOCK_PROCESS_CPUTIME_ID);
}

double threadSeconds()
{
    return secondsOf(CLOCK_THREAD_CPUTIME_ID);
}

} // namespace geofx::bench
