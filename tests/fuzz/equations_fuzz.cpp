// libFuzzer on a plant's texts: for any bytes, the result is either a printable error, or a plant with finite numbers.
// Lines: output, dx/dt, dz/dt, a parameter. The same bytes are also read as a typed plant, whose texts must be read
// back, and as a typed controller.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

#include "api/contract/device/typed_controller.h"
#include "engine/controller/product/catalogue.h"
#include "engine/plant/nonlinear/lie_derivatives.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/plant/typed/plant_snippets.h"
#include "engine/plant/typed/typed_plant.h"
#include "engine/plant/typed/words.h"

namespace {

using namespace tunewright;

void require(bool holds, const char* what, const std::string& detail = "") {
    if (holds) return;
    std::cerr << "broken promise: " << what << "\n" << detail << "\n";
    std::abort();
}

// Printable ASCII and whole UTF-8 sequences only.
bool can_be_shown(const std::string& message) {
    for (std::size_t i = 0; i < message.size();) {
        const auto lead = static_cast<unsigned char>(message[i++]);
        if (lead < 0x20 || lead == 0x7F || lead == 0xC0 || lead == 0xC1 || lead > 0xF4) return false;
        int following = lead < 0x80 ? 0 : lead < 0xC0 ? -1 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
        if (following < 0) return false;
        for (; following > 0; --following, ++i)
            if (i >= message.size() || (static_cast<unsigned char>(message[i]) & 0xC0) != 0x80) return false;
    }
    return !message.empty();
}

NonlinearPlant plant_of(const std::string& text) {
    std::array<std::string, 4> lines;
    std::size_t begin = 0;
    for (std::string& line : lines) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        line = text.substr(std::min(begin, text.size()), end - std::min(begin, end));
        begin = end + 1;
        if (end == text.size()) break;
    }
    return {.states = {{"x", 0.5}, {"z", 2}},
            .parameters = {{"a", lines[3]}, {"b", 3.0}},
            .equations = {{"x", lines[1]}, {"z", lines[2]}},
            .input = {.name = "u", .nominal = 1},
            .output = lines[0]};
}

void examine(const NonlinearSystem& system) {
    const StateSpace& linear = system.linearised();
    for (std::size_t i = 0; i < 2; ++i) {
        require(std::isfinite(system.x_steady()[i]), "a finite steady state");
        require(std::isfinite(linear.B[i]) && std::isfinite(linear.C[i]), "finite derivatives");
        for (const double a : linear.A[i]) require(std::isfinite(a), "finite derivatives");
    }
    require(system.domain_fault(system.x_steady(), system.u_nominal()).empty(), "a steady state inside the domain");
    const auto r = relative_degree(system);
    if (!r) return require(can_be_shown(r.error().message), "a readable error", r.error().message);
    LieDerivatives lie;
    require(lie_derivatives(system, *r, system.x_steady(), lie), "Lie derivatives at the operating point");
    require(lie.of_g != 0, "an effect of the input");
    for (const auto zero : zero_dynamics(system).zeros) require(!std::isnan(zero.real()), "zeros that are numbers");
    // Away from the operating point any evaluation may fail, but must report that.
    const std::array<double, 2> far = {-3, 1e6};
    std::array<double, 2> rates = {};
    require(system.rates(far, -1, rates) || can_be_shown(system.domain_fault(far, -1)),
            "a reason for leaving the domain");
}

void read_as_typed(const std::string& text) {
    const auto typed = read_plant(text);
    if (!typed) return require(can_be_shown(typed.error().message), "a readable error", typed.error().message);
    const std::string written = plant_text(typed->plant);
    require(written.empty() || read_plant(written).has_value(), "a text that is read back", written);
    for (const PlantSnippet& snippet : plant_snippets(typed->plant, "s"))
        if (snippet.text.size() <= typed::kMaxLength &&
            !(snippet.name.starts_with("Python") && dead_time(typed->plant) != 0))
            require(read_plant(snippet.text).has_value(), "a program that is read back", snippet.text);
}

void read_as_controller(const std::string& text) {
    const auto typed = api::read_controller(text);
    if (!typed) return require(can_be_shown(typed.error().message), "a readable error", typed.error().message);
    require(product::find(typed->product) != nullptr, "a known product", typed->product);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    read_as_typed(text);
    read_as_controller(text);
    const auto system = NonlinearSystem::make(plant_of(text));
    if (system)
        examine(*system);
    else
        require(can_be_shown(system.error().message), "a readable error", system.error().message);
    return 0;
}
