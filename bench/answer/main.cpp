// What each part of an answer costs, over random first-order plants with dead time, on one core: the design itself and
// all that is computed and written with it. `run` adds the store and HTTP around it.
//
//   answer_parts [plants] [points]     prints a table in Markdown: milliseconds, median and mean over the plants
//   answer_parts --request FILE [runs]   runs one request again and again, for a profile; prints the shortest time
//
// A part's time on a plant is the shortest of a few runs, which is what the machine takes undisturbed. A part without a
// function of its own is what the whole takes beyond its parts.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "api/service.h"
#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/longest_sample_time.h"
#include "engine/number_text.h"
#include "engine/request/optimum_at_ms.h"
#include "engine/request/tune.h"
#include "engine/tuning/method/setpoint.h"
#include "engine/tuning/registry.h"

namespace tunewright::bench {
namespace {

constexpr int kRuns = 5;
constexpr double kShortestDeadTime = 0.05, kLongestDeadTime = 5;  // of T

struct Part {
    const char* name;
    std::vector<double> ms = {};
};

double once_ms(const std::function<void()>& part) {
    const auto start = std::chrono::steady_clock::now();
    part();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double shortest_ms(const std::function<void()>& part) {
    double best = HUGE_VAL;
    for (int run = 0; run < kRuns; ++run) best = std::min(best, once_ms(part));
    return best;
}

std::string request_of(const Fopdt& plant, int points) {
    return R"({"plant": {"type": "fopdt", "K": )" + text(plant.K, 17) + R"(, "T": )" + text(plant.T, 17) +
           R"(, "L": )" + text(plant.L, 17) + R"(}, "tune": [{"method": "robust"}], "evaluate": {"points": )" +
           std::to_string(points) + "}}";
}

class Parts {
public:
    explicit Parts(int points) : points_(points) {}

    void add(const Fopdt& plant) {
        const Plant given = plant;
        const auto linear = LinearPlant::make(given);
        const TuningProblem problem{given, *linear, std::nullopt};
        const TuningMethod& robust = *find_method("robust");
        MethodOptions options = with_defaults(robust.options, {});
        const SetpointOptions setpoint = wanted_setpoint(robust, options);
        EvaluateOptions evaluate_options;
        evaluate_options.points = points_;
        TuningRequest request;
        request.subject = std::get<AnalysedPlant>(AnalysedPlant::make(given));
        request.evaluate = evaluate_options;

        auto tuned = robust.tune(problem, options, {});
        if (!tuned) return;
        const TunedController bare = *tuned;
        double sum = 0;
        const auto part = [&](Part& to, const std::function<void()>& work) {
            to.ms.push_back(shortest_ms(work));
            sum += to.ms.back();
        };
        part(design_, [&] { tuned = robust.tune(problem, options, {}); });
        part(setpoint_, [&] {
            *tuned = bare;
            weigh_setpoint(*linear, setpoint, *tuned);
        });
        Expected<Evaluation> evaluation = Error{};
        part(evaluation_, [&] { evaluation = evaluate(*request.subject, tuned->controller, evaluate_options); });
        part(sample_time_, [&] { longest_sample_time_of(*request.subject, *evaluation); });
        part(pi_, [&] { best_PI_load_IAE(problem, options, evaluate_options, {}); });
        const double engine = shortest_ms([&] { (void)tune(request, {}); });
        verdict_.ms.push_back(engine - sum);
        const std::string body = request_of(plant, points_);
        const double whole = shortest_ms([&] { api::design_call(body, {}); });
        text_.ms.push_back(whole - engine);
        whole_.ms.push_back(whole);
    }

    void print() {
        std::printf("| part | median ms | mean ms |\n| --- | --- | --- |\n");
        for (Part* part : {&design_, &setpoint_, &evaluation_, &sample_time_, &pi_, &verdict_, &text_, &whole_}) {
            std::ranges::sort(part->ms);
            double sum = 0;
            for (const double ms : part->ms) sum += ms;
            std::printf("| %s | %.3f | %.3f |\n", part->name, part->ms[part->ms.size() / 2],
                        sum / static_cast<double>(part->ms.size()));
        }
    }

private:
    int points_;
    Part design_{"the design"}, setpoint_{"its set-point weight and filter"}, evaluation_{"its evaluation"},
        sample_time_{"the longest sample time"}, pi_{"the PI next to it"}, verdict_{"verdict and the rest"},
        text_{"JSON, in and out"}, whole_{"all"};
};

}  // namespace
}  // namespace tunewright::bench

namespace tunewright::bench {
namespace {

int run_request(const char* file, int runs) {
    std::ifstream in(file);
    const std::string body((std::istreambuf_iterator<char>(in)), {});
    const auto job = api::prepare_job(body);
    if (const auto* problem = std::get_if<api::Problem>(&job)) {
        std::fprintf(stderr, "%s: %s\n", file, problem->detail.c_str());
        return 1;
    }
    double best = HUGE_VAL;
    for (int run = 0; run < runs; ++run)
        best = std::min(best, once_ms([&] { api::run_job(std::get<api::PreparedJob>(job), {}); }));
    std::printf("%.3f ms\n", best);
    return 0;
}

}  // namespace
}  // namespace tunewright::bench

int main(int argc, char** argv) {
    using namespace tunewright::bench;
    if (argc > 2 && std::string(argv[1]) == "--request")
        return run_request(argv[2], argc > 3 ? std::atoi(argv[3]) : 20);
    const int plants = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
    Parts parts(argc > 2 ? std::atoi(argv[2]) : 0);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(0, 1);
    for (int i = 0; i < plants; ++i) {
        const double T = std::pow(10, 3 * place(random) - 1);
        const double L = T * kShortestDeadTime * std::pow(kLongestDeadTime / kShortestDeadTime, place(random));
        parts.add({.K = std::pow(10, 2 * place(random) - 1), .T = T, .L = L});
    }
    parts.print();
    return 0;
}
