#include "engine/structure/program/sampled_structure.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "engine/code/algorithm.h"
#include "engine/code/interpreter.h"
#include "engine/loop/sampled/held_plant.h"
#include "engine/numerics/fourier.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/simulation/run/held_motion.h"
#include "engine/simulation/run/stopping_rule.h"
#include "engine/structure/loop_design.h"

namespace tunewright::structure {
namespace {

using Index = std::size_t;

constexpr int kMaxCalls = 40000;
constexpr double kSettled = 1e-6;   // of each signal's largest deviation
constexpr double kAtTarget = 1e-4;  // of the largest deviation: where a response that rests has no error
constexpr double kWindow = 1.5;     // a response has settled if it rests from some time until this many times that time
constexpr int kFirstCalls = 40;     // and two dead times: before that no response has settled
constexpr Index kFinerSpectrum = 4;  // frequencies for each call
constexpr int kSections = 30;        // of the golden section between two of them

/// The plants, and what has been held at their inputs. A period has pieces, because dead times end within it.
class HeldPlants {
public:
    HeldPlants(const PlantMatrix& plants, double Ts) : borders_{0, Ts}, held_(plants.front().size()) {
        for (Index i = 0; i < plants.size(); ++i) {
            for (Index j = 0; j < plants[i].size(); ++j) {
                if (!plants[i][j]) continue;
                paths_.push_back({j, i, HeldMotion(*plants[i][j], 1, true), in_samples(plants[i][j]->dead_time(), Ts)});
                borders_.push_back(paths_.back().delay.rest);
                longest_delay_ = std::max(longest_delay_, paths_.back().delay.whole);
            }
        }
        std::sort(borders_.begin(), borders_.end());
        borders_.erase(std::unique(borders_.begin(), borders_.end()), borders_.end());
        for (Path& path : paths_) {
            path.x.assign(static_cast<Index>(path.motion.states()), 0.0);
            for (Index m = 1; m < borders_.size(); ++m)
                path.steps.push_back(path.motion.step(borders_[m] - borders_[m - 1]));
        }
    }

    const std::vector<double>& borders() const { return borders_; }
    int longest_delay() const { return longest_delay_; }
    void hold(Index j, double v) { held_[j].push_back(v); }

    /// y_i and its slope at the present end of piece m of period k, and the integral of -y_i.
    ResponseNode node(Index i, int k, Index m) const {
        ResponseNode sum;
        for (const Path& path : paths_) {
            if (path.to != i) continue;
            const OutputMotion now = path.motion.output(path.x, input(path, k, m));
            sum.y += now.y;
            sum.y_slope += now.slope;
            sum.error_integral -= path.x.back();
        }
        return sum;
    }
    void advance(int k, Index m) {
        for (Path& path : paths_) path.motion.advance(path.steps[m], input(path, k, m), path.x);
    }

private:
    struct Path {
        Index from, to;
        HeldMotion motion;
        SampledDelay delay;
        std::vector<HeldStep> steps = {};  // one for each piece
        std::vector<double> x = {};
    };

    double input(const Path& path, int k, Index m) const {
        const int at = k - path.delay.whole - (borders_[m] >= path.delay.rest ? 0 : 1);
        return at < 0 ? 0 : held_[path.from][static_cast<Index>(at)];
    }

    std::vector<double> borders_;  // of the pieces
    std::vector<Path> paths_;
    std::vector<std::vector<double>> held_;
    int longest_delay_ = 0;
};

/// One run of the program on the plants, from rest. With a pulse at a place the program has no limits.
class SampledStructureRun {
public:
    SampledStructureRun(const code::Program& program, const SampledScene& scene, const SampledStep& step,
                        const SampledPlace* pulse)
        : scene_(scene),
          step_(step),
          pulse_(pulse),
          program_(program),
          Ts_(program_["Ts"]),
          plants_(scene.plants, Ts_),
          y_(scene.plants.size()),
          nodes_(pulse == nullptr ? scene.controlled : 0) {
        if (pulse_ != nullptr) remove_limits(program);
        program_["at_rest"] = 1;
        for (const auto& [signal, setting] : scene.rest) program_[signal] = program_[setting];
        for (const auto& [input, value] : step.inputs) program_[input] += value;
        for (const code::Declaration& output : code::of_role(program, code::VariableRole::output))
            outputs_.push_back(output.name);
        u_.resize(outputs_.size());
    }

    /// Ends when everything rests, and returns true, or when it is unbounded or stopped.
    bool settles(const RunControl& control) {
        const int start = kFirstCalls + 2 * plants_.longest_delay();
        int next = start;
        double first = 0;  // the largest signal of the first calls
        std::vector<double> low, high, largest(y_.size() + u_.size());
        for (int k = 0; k < kMaxCalls && !control.stop.stop_requested(); ++k) {
            call(k);
            if (low.empty()) low = high = std::vector<double>(largest.size(), 0.0);
            bool rests = k >= next, bounded = true;
            for (Index i = 0; i < largest.size(); ++i) {
                const double now = i < y_.size() ? y_[i].back() : u_[i - y_.size()].back();
                largest[i] = std::max(largest[i], std::abs(now));
                low[i] = std::min(low[i], now);
                high[i] = std::max(high[i], now);
                rests = rests && high[i] - low[i] <= kSettled * largest[i];
                if (k < start) first = std::max(first, largest[i]);
                bounded = bounded && largest[i] <= kMaxResponseRatio * first;
                if (k >= next) low[i] = high[i] = now;
            }
            if (rests || !bounded) return rests;
            if (k >= next) next = static_cast<int>(kWindow * next);
        }
        return false;
    }

    SampledResponse response(bool settles) {
        SampledResponse out{step_.name, {}, 0, std::move(y_), std::move(u_)};
        for (Index i = 0; i < nodes_.size(); ++i) {
            StepResponse all;
            all.nodes = std::move(nodes_[i]);
            all.settles = settles;
            if (settles) all.error_integral_final = final_integral(all.nodes, target(i));
            out.figures.push_back(figures_of(all, target(i)));
        }
        double before = 0;
        for (const double u : out.u.front())
            out.largest_rate = std::max(out.largest_rate, std::abs(u - std::exchange(before, u)) / Ts_);
        return out;
    }

    /// The final integral of a response that rests; empty if it does so away from its target.
    static std::optional<double> final_integral(const std::vector<ResponseNode>& nodes, double target) {
        const Extremes extremes = extremes_of_y(nodes);
        const double largest = std::max({std::abs(target), extremes.max, -extremes.min});
        if (std::abs(target - nodes.back().y) > kAtTarget * largest) return std::nullopt;
        return nodes.back().error_integral;
    }

    /// The largest magnitude of the transform of the place's signal.
    double peak() const {
        std::vector<double> padded = broken_;
        padded.resize(quick_length(kFinerSpectrum * broken_.size()));
        const auto spectrum = half_spectrum(padded);
        const auto largest = std::max_element(spectrum.begin(), spectrum.end(),
                                              [](auto a, auto b) { return std::norm(a) < std::norm(b); });
        const double step = 2 * std::numbers::pi / static_cast<double>(padded.size()),
                     at = step * static_cast<double>(largest - spectrum.begin());
        const auto less = [&](double angle) {
            const std::complex<double> back = std::polar(1.0, -angle);
            std::complex<double> sum = 0;
            for (Index k = broken_.size(); k-- > 0;) sum = sum * back + broken_[k];
            return -std::abs(sum);
        };
        return -less(golden_section(less, std::max(0.0, at - step), std::min(std::numbers::pi, at + step), kSections));
    }

private:
    double target(Index i) const { return i < step_.targets.size() ? step_.targets[i] : 0; }

    void remove_limits(const code::Program& program) {
        for (const code::Declaration& setting : code::of_role(program, code::VariableRole::parameter)) {
            const auto is = [&](const char* part) { return setting.name.find(part) != std::string::npos; };
            if (is("_min")) program_[setting.name] = -code::kNoLimit;
            if (is("_max")) program_[setting.name] = code::kNoLimit;
            if (is("rate_limit") || setting.name == "gap") program_[setting.name] = 0;
        }
    }

    /// 1 at the time and the place of the pulse.
    double pulse(int k, bool at_plant_input, Index signal) const {
        return pulse_ != nullptr && k == 0 && pulse_->at_plant_input == at_plant_input && pulse_->signal == signal ? 1
                                                                                                                   : 0;
    }

    /// By how much the program moves a signal.
    double moved(const std::string& output) {
        const auto rest = scene_.rest.find(output);
        return program_[output] - (rest == scene_.rest.end() ? 0 : program_[rest->second]);
    }

    void call(int k) {
        const Index pieces = plants_.borders().size() - 1;
        for (Index i = 0; i < y_.size(); ++i) {
            y_[i].push_back(k == 0 ? 0 : plants_.node(i, k - 1, pieces - 1).y);
            const double signal = y_[i].back() + pulse(k, false, i);
            const std::string& name = scene_.measurements[i];
            program_[name] = signal + program_[scene_.rest.at(name)];
            if (pulse_ != nullptr && !pulse_->at_plant_input && pulse_->signal == i) broken_.push_back(signal);
        }
        program_.call();
        for (Index j = 0; j < outputs_.size(); ++j) u_[j].push_back(moved(outputs_[j]));
        for (Index j = 0; j < scene_.plants.front().size(); ++j) {
            const auto load = step_.loads.find(j);
            const double signal = (j < scene_.outputs.size() ? moved(scene_.outputs[j]) : 0) + pulse(k, true, j);
            plants_.hold(j, signal + (load == step_.loads.end() ? 0 : load->second));
            if (pulse_ != nullptr && pulse_->at_plant_input && pulse_->signal == j) broken_.push_back(signal);
        }
        for (Index m = 0; m < pieces; ++m) {
            add_nodes(k, m, k * Ts_ + plants_.borders()[m]);
            plants_.advance(k, m);
            add_nodes(k, m, m + 1 < pieces ? k * Ts_ + plants_.borders()[m + 1] : (k + 1) * Ts_);
        }
    }

    void add_nodes(int k, Index m, double t) {
        for (Index i = 0; i < nodes_.size(); ++i) {
            ResponseNode node = plants_.node(i, k, m);
            node.t = t;
            node.u = moved(scene_.outputs[i]);
            node.error_integral += target(i) * node.t;
            // A second node at the same time only where something jumps.
            const ResponseNode* last = nodes_[i].empty() ? nullptr : &nodes_[i].back();
            const bool jumps = last == nullptr || last->y_slope != node.y_slope || last->u != node.u;
            if (jumps || last->t != node.t) nodes_[i].push_back(node);
        }
    }

    const SampledScene& scene_;
    const SampledStep step_;
    const SampledPlace* pulse_;
    code::Interpreter program_;
    const double Ts_;
    HeldPlants plants_;
    std::vector<std::string> outputs_;
    std::vector<std::vector<double>> y_, u_;
    std::vector<std::vector<ResponseNode>> nodes_;
    std::vector<double> broken_;  // the signal at the pulse
};

SampledStep sized(SampledStep step, const std::map<std::string, double>& sizes) {
    const auto given = sizes.find(step.name);
    const double size = given == sizes.end() ? 1 : given->second;
    for (auto& [input, value] : step.inputs) value *= size;
    for (auto& [input, value] : step.loads) value *= size;
    for (double& target : step.targets) target *= size;
    return step;
}

/// A run that was stopped has no figures: it may have made no call.
Error stopped() { return {ErrorKind::cancelled, "", "The run was stopped."}; }

}  // namespace

Expected<SampledAnswer> run_sampled(const code::Program& program, const SampledScene& scene,
                                    const std::map<std::string, double>& sizes, const RunControl& control) {
    const double Ts = code::Interpreter(program)["Ts"];
    for (const auto& row : scene.plants)
        for (const auto& plant : row)
            if (const auto error = plant ? refuse_sampling(*plant, Ts, 0) : std::nullopt) return *error;
    SampledAnswer out;
    for (const SampledPlace& place : scene.places) {
        SampledStructureRun run(program, scene, {place.name, place.inputs}, &place);
        const bool settles = run.settles(control);
        if (control.stop.stop_requested()) return stopped();
        out.Ms[place.name] = settles
                                 ? Figure(run.peak())
                                 : no_figure("The sampled loop is not stable, or is not at rest after 40000 calls.");
    }
    for (const SampledStep& step : scene.steps) {
        SampledStructureRun run(program, scene, sized(step, sizes), nullptr);
        const bool settles = run.settles(control);
        if (control.stop.stop_requested()) return stopped();
        out.responses.push_back(run.response(settles));
    }
    return out;
}

Expected<SampledScene> cascade_scene(const CascadePlants& plants) {
    const bool series = plants.arrangement == Arrangement::series;
    const auto whole = series ? LinearPlant::make(Plant(factors_of(plants.inner, plants.outer))) : plants.outer;
    if (!whole) return whole.error();
    return SampledScene{
        .plants = {{*whole, plants.outer}, {plants.inner, std::nullopt}},
        .measurements = {"measurement", "inner_measurement"},
        .outputs = {"u"},
        .rest = {{"setpoint", "outer_y0"},
                 {"measurement", "outer_y0"},
                 {"inner_measurement", "r2_bias"},
                 {"inner_setpoint", "r2_bias"},
                 {"r2", "r2_bias"},
                 {"u", "bias"}},
        .steps = {{"inner_load", {}, {{0, 1}}}, {"outer_load", {}, {{1, 1}}}, {"setpoint", {{"setpoint", 1}}, {}, {1}}},
        .places = {{"inner", false, 1, {{"cascade_on", -1}}}, {"outer", false, 0}, {"valve", true, 0}}};
}

SampledScene loop_scene(const LinearPlant& plant) {
    return {.plants = {{plant}},
            .measurements = {"measurement"},
            .outputs = {"u"},
            .rest = {{"setpoint", "y0"}, {"measurement", "y0"}, {"u", "bias"}},
            .steps = {{"load", {}, {{0, 1}}}, {"setpoint", {{"setpoint", 1}}, {}, {1}}},
            .places = {{"loop", false, 0}}};
}

SampledScene feedforward_scene(const LinearPlant& plant, const LinearPlant& disturbance) {
    SampledScene out = loop_scene(plant);
    out.plants[0].emplace_back(disturbance);
    out.rest["disturbance"] = "d0";
    out.steps = {{"disturbance", {{"disturbance", 1}}, {{1, 1}}}};
    return out;
}

SampledScene level_scene(double area, const FlowLoop& flow) {
    const auto plant = [&](double gain, double T, double L) {
        return *LinearPlant::make(Plant(TransferFunction{.num = {gain}, .den = {area * T, area, 0}, .L = L}));
    };
    SampledScene out = loop_scene(plant(-1, flow.T, flow.L));
    out.plants[0].emplace_back(plant(1, 0, 0));
    out.steps = {{"load", {}, {{1, 1}}}};
    return out;
}

SampledScene interaction_scene(const PlantMatrix& plants) {
    SampledScene out;
    out.plants = plants;
    out.controlled = plants.size();
    for (Index i = 0; i < plants.size(); ++i) {
        const std::string s = "_" + std::to_string(i + 1), r = "setpoint" + s, y = "measurement" + s, u = "u" + s;
        out.measurements.push_back(y);
        out.outputs.push_back(u);
        out.rest.insert({{r, "y0" + s}, {y, "y0" + s}, {u, "bias" + s}});
        std::vector<double> targets(plants.size(), 0.0);
        targets[i] = 1;
        out.steps.push_back({"load" + s, {}, {{i, 1}}});
        out.steps.push_back({r, {{r, 1}}, {}, targets});
        out.places.push_back({"loop" + s, false, i});
    }
    return out;
}

}  // namespace tunewright::structure
