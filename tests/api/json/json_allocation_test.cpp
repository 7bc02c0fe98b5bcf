// Memory that runs out while a text is read: an exception that the server answers, and nothing else.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <new>
#include <string>
#include <variant>

#include "api/json/json.h"

namespace {

/// Allocations of this thread until one fails.
thread_local std::size_t left = std::numeric_limits<std::size_t>::max();

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t bytes) {
    if (left-- == 0) throw std::bad_alloc();
    if (void* memory = std::malloc(bytes)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace tunewright::api {
namespace {

TEST(JsonAllocation, AFailureAtAnyCallIsAnExceptionAndLeavesNothing) {
    std::string text = R"({"a text that is longer than what a string holds in itself": [)";
    for (int i = 0; i < 120; ++i)
        text += (i > 0 ? "," : "") +
                std::string(R"({"K": [1, 2.5, -3e-7], "name": "a text on the free store", "T": {"a": [[]]}})");
    text += "]}";
    const std::string whole = std::get<Json>(parse(text)).dump();
    std::size_t failures = 0;
    for (bool failed = true; failed; ++failures) {
        left = failures;
        try {
            const auto parsed = parse(text);
            left = std::numeric_limits<std::size_t>::max();
            failed = false;
            EXPECT_EQ(std::get<Json>(parsed).dump(), whole);
        } catch (const std::bad_alloc&) {
            left = std::numeric_limits<std::size_t>::max();
        }
    }
    EXPECT_GT(failures, 1000U);
}

}  // namespace
}  // namespace tunewright::api
