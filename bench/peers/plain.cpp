// Robust PID design in the way of Garpinger and Hägglund (2008), as a program of one file that uses the standard
// library only and nothing of the engine: Nelder-Mead over (ln Ti, ln Td), the gain from the Ms and Mt circles on a
// frequency grid, the load IAE by a simulation of fixed step with a buffer for the dead time.
//
//   peers_plain [pi] [exact] < plants
//       reads name, num, den, dead time between tabs; writes name, Kp, Ti, Td, ms, IAE of its own simulation; ms is the
//       shorter of two runs. `pi`: without derivative and filter, over ln Ti alone. `exact`: with the frequencies and
//       starts that it takes on the plants of the AMIGO batch, found by trying, to come within 0.1 % of every optimum
//       with limits held to 0.1 %, most of them to 2e-5

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Complex = std::complex<double>;

/// What a design's accuracy costs.
struct Effort {
    int frequencies = 500;  ///< log-spaced from kLowest on
    double highest = 50;    ///< in phase crossovers
    int starts = 1;
};
constexpr Effort kExactPid = {4000, 1000, 2}, kExactPi = {1500, 50, 1};

constexpr double kM = 1.4;         // limit of Ms and of Mt
constexpr double kTfOverTd = 0.1;  // the measurement filter is 1/(1 + s Tf + (s Tf)^2/2)
constexpr double kLowest = 0.005;  // of the frequencies, in phase crossovers
constexpr double kStep = 0.1;      // of the simulation, in 1/phase crossover
constexpr int kMaxSteps = 40000;
constexpr int kRuns = 2;

/// num(s)/den(s) e^(-Ls), coefficients in ascending powers of s, in a unit of time in which the phase crossover is 1.
struct Plant {
    std::vector<double> num, den;
    double L = 0;

    Complex at(Complex s) const {
        const auto value = [&](const std::vector<double>& p) {
            Complex sum = 0;
            for (auto c = p.rbegin(); c != p.rend(); ++c) sum = sum * s + *c;
            return sum;
        };
        return value(num) / value(den) * std::exp(-L * s);
    }

    void count_time_in(double w) {
        for (auto* p : {&num, &den})
            for (std::size_t i = 0; i < p->size(); ++i) (*p)[i] *= std::pow(w, double(i));
        L *= w;
    }
};

/// The frequency at which the phase first passes -180 degrees.
double phase_crossover(const Plant& plant) {
    const bool integrates = plant.den[0] == 0;
    const std::size_t first = integrates ? 1 : 0;
    const double scale = plant.L + (plant.den.size() > first + 1 ? plant.den[first + 1] / plant.den[first] : 0);
    double phase = integrates ? -std::numbers::pi / 2 : 0, w = 1e-6 / scale;
    Complex last = plant.at({0, w});
    for (;; w *= 1.002) {
        const Complex now = plant.at({0, w});
        phase += std::arg(now / last);
        last = now;
        if (phase <= -std::numbers::pi || w > 1e9 / scale) return w;
    }
}

// ---- x' = A x + B v with v linear between samples, exactly: x+ = Phi x + B0 v + B1 v+ ----

constexpr int kMost = 8;  // states
using Vector = std::array<double, kMost>;

struct Discrete {
    int n = 0;
    std::array<Vector, kMost> columns{};  // of Phi
    Vector B0{}, B1{};

    /// x becomes Phi x + B0 v + B1 next. Columns of one length, so that the compiler uses vector instructions.
    void step(Vector& x, double v, double next) const {
        Vector sum;
        for (int i = 0; i < kMost; ++i) sum[i] = B0[i] * v + B1[i] * next;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < kMost; ++i) sum[i] += columns[j][i] * x[j];
        x = sum;
    }
};

using Matrix = std::array<std::array<double, kMost + 2>, kMost + 2>;

Matrix product(const Matrix& a, const Matrix& b, int n) {
    Matrix c{};
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            for (int j = 0; j < n; ++j) c[i][j] += a[i][k] * b[k][j];
    return c;
}

/// e^A by scaling, a series of Taylor, and squaring.
Matrix exponential(Matrix a, int n) {
    double norm = 0;
    for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int j = 0; j < n; ++j) sum += std::abs(a[i][j]);
        norm = std::max(norm, sum);
    }
    const int squarings = std::max(0, int(std::ceil(std::log2(norm))) + 2);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) a[i][j] = std::ldexp(a[i][j], -squarings);
    Matrix sum{}, term{};
    for (int i = 0; i < n; ++i) sum[i][i] = term[i][i] = 1;
    for (int k = 1; k <= 12; ++k) {
        term = product(term, a, n);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) sum[i][j] += term[i][j] /= k;
    }
    for (int i = 0; i < squarings; ++i) sum = product(sum, sum, n);
    return sum;
}

/// `system` holds A in its first n rows and columns and B in column n.
Discrete discretised(Matrix system, int n, double dt) {
    for (auto& row : system)
        for (double& value : row) value *= dt;
    system[n][n + 1] = 1;  // v' = (v+ - v)/dt
    const Matrix e = exponential(system, n + 2);
    Discrete result;
    result.n = n;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) result.columns[j][i] = e[i][j];
        result.B1[i] = e[i][n + 1];
        result.B0[i] = e[i][n] - e[i][n + 1];
    }
    return result;
}

struct Shape {
    double Ti = 0, Td = 0;  // Td = 0: a PI without filter
};

class Design {
public:
    Design(const Plant& plant, const Effort& effort) : plant_(plant) {
        for (int i = 0; i < effort.frequencies; ++i) {
            const double w = kLowest * std::pow(effort.highest / kLowest, double(i) / (effort.frequencies - 1));
            s_.emplace_back(0, w);
            P_.push_back(plant.at(s_.back()));
        }
        n_ = int(plant.den.size()) - 1;
        delay_ = int(std::ceil(plant.L / kStep));
        dt_ = delay_ ? plant.L / delay_ : kStep;
        Matrix companion{};
        for (int i = 0; i + 1 < n_; ++i) companion[i][i + 1] = 1;
        for (int j = 0; j < n_; ++j) companion[n_ - 1][j] = -plant.den[j] / plant.den[n_];
        companion[n_ - 1][n_] = 1;
        stepped_ = discretised(companion, n_, dt_);
        for (std::size_t j = 0; j < plant.num.size(); ++j) C_[j] = plant.num[j] / plant.den[n_];
    }

    /// AMIGO's rules on the ultimate point (Åström and Hägglund 2006); their gain is not used.
    Shape start(bool pi) const {
        const double Tu = 2 * std::numbers::pi,
                     static_gain = plant_.den[0] == 0 ? INFINITY : plant_.num[0] / plant_.den[0];
        const double kappa = std::abs(plant_.at({0, 1})) / static_gain;
        Shape shape = {0.6 / (1 + 2 * kappa) * Tu, std::max(0.15 * (1 - kappa) / (1 - 0.95 * kappa), 0.02) * Tu};
        if (pi) shape = {1 / (1 + 4.5 * kappa) * Tu, 0};
        while (gain(shape) == 0 && shape.Ti < 1000 * Tu) shape.Ti *= 1.5;  // two integrators need a slow one
        return shape;
    }

    /// The largest gain with which the loop is stable and outside both circles; 0 where there is none.
    double gain(const Shape& shape) const {
        std::vector<Complex> G(s_.size());
        for (std::size_t i = 0; i < s_.size(); ++i) G[i] = P_[i] * controller(shape, s_[i]);
        struct Interval {
            double low, high;
        };
        std::vector<Interval> forbidden;
        // Both circles: a K^2 + 2 b K + c >= 0.
        const auto forbid = [&](double a, double b, double c) {
            const double d = b * b - a * c;
            if (b < 0 && d > 0) forbidden.push_back({c / (-b + std::sqrt(d)), (-b + std::sqrt(d)) / a});
        };
        for (const Complex& g : G) {
            const double size = std::norm(g);
            forbid(size, g.real(), 1 - 1 / (kM * kM));
            forbid(size * (1 - 1 / (kM * kM)), g.real(), 1);
        }
        std::sort(forbidden.begin(), forbidden.end(), [](auto& a, auto& b) { return a.low < b.low; });
        double largest = 0, reached = 0;
        for (const auto& interval : forbidden) {
            if (interval.low > reached && stable(G, interval.low)) largest = interval.low;
            reached = std::max(reached, interval.high);
        }
        return largest;
    }

    double cost(const Shape& shape) const {
        const double K = gain(shape);
        return K > 0 ? iae(K, shape) : INFINITY;
    }

    /// Of the unit load step at the plant's input. Integral action makes the integral of y end at Ti/K: when it has
    /// come there to stay, the response has settled.
    double iae(double K, const Shape& shape) const {
        const double Tf = kTfOverTd * shape.Td, end = shape.Ti / K;
        const bool filtered = Tf > 0;
        const int states = filtered ? 3 : 1;  // integral of y_f, y_f, y_f'
        Matrix filter{};
        filter[0][1] = 1;
        if (filtered) {
            filter[1][2] = 1;
            filter[2] = {0, -2 / (Tf * Tf), -2 / Tf, 2 / (Tf * Tf)};
        }
        const Discrete measured = discretised(filter, states, dt_);
        const Vector gains = {-K / shape.Ti, -K, -K * shape.Td};
        const double direct = filtered ? 0 : -K;
        const double h = dot(C_, stepped_.B1, n_), g = dot(gains, measured.B1, states) + direct;
        std::vector<double> u(std::size_t(delay_) + 1, 0.0);  // a ring
        Vector x{}, c{};
        double y = 0, v = 1, sum = 0, absolute = 0;
        int quiet = 0;
        for (int k = 1; k < kMaxSteps && quiet < 10 / dt_; ++k) {
            double next = 1;
            if (delay_) {
                next += u[std::size_t(k) % u.size()];
            } else {  // u answers y and y answers u within the step
                Vector free = x, c_free = c;
                stepped_.step(free, v, 0);
                measured.step(c_free, y, 0);
                const double y0 = dot(C_, free, n_), u0 = dot(gains, c_free, states);
                next += u0 + g * (y0 + h * (1 + u0)) / (1 - h * g);
            }
            stepped_.step(x, v, next);
            const double now = dot(C_, x, n_);
            measured.step(c, y, now);
            u[std::size_t(k + delay_) % u.size()] = dot(gains, c, states) + direct * now;
            sum += dt_ * (y + now) / 2;
            absolute += dt_ * (y * now < 0 ? (y * y + now * now) / (2 * std::abs(y - now)) : std::abs(y + now) / 2);
            y = now;
            v = next;
            if (!(absolute < 1e6 * end)) return INFINITY;
            quiet = std::abs(sum - end) < 2e-5 * absolute ? quiet + 1 : 0;
        }
        return absolute + std::abs(end - sum);
    }

private:
    static double dot(const Vector& a, const Vector& b, int n) {
        double sum = 0;
        for (int i = 0; i < n; ++i) sum += a[i] * b[i];
        return sum;
    }

    static Complex controller(const Shape& shape, Complex s) {
        const Complex f = s * (kTfOverTd * shape.Td);
        return (1.0 + 1.0 / (s * shape.Ti) + s * shape.Td) / (1.0 + f + f * f / 2.0);
    }

    /// By Nyquist: 1 + L, of a plant without unstable poles, ends at 1 without a turn.
    static bool stable(const std::vector<Complex>& G, double K) {
        Complex last = 1.0 + K * G.front();
        double angle = std::arg(last);
        if (angle > std::numbers::pi / 2) angle -= 2 * std::numbers::pi;  // two integrators, and a lag before the lead
        for (const Complex& g : G) {
            const Complex now = 1.0 + K * g;
            angle += std::arg(now * std::conj(last));
            last = now;
        }
        return std::abs(angle) < 2;
    }

    Plant plant_;
    std::vector<Complex> s_, P_;
    int n_ = 0, delay_ = 0;
    double dt_ = 0;
    Discrete stepped_;
    Vector C_{};
};

// ---- Nelder and Mead (1965), on a line or in the plane ----

struct Point {
    std::array<double, 2> x{};
    double cost = INFINITY;
};

/// From n + 1 corners in n dimensions.
template <typename Cost>
Point nelder_mead(const Cost& cost, std::vector<Point> simplex) {
    const std::size_t n = simplex.size() - 1;
    const auto lower = [](const Point& a, const Point& b) { return a.cost < b.cost; };
    const auto at = [&](const std::array<double, 2>& x) { return Point{x, cost(x)}; };
    for (auto& p : simplex) p = at(p.x);
    for (int i = 0; i < 200; ++i) {
        std::sort(simplex.begin(), simplex.end(), lower);
        const Point &best = simplex.front(), &last_but_one = simplex[n - 1];
        Point& worst = simplex.back();
        const double size = std::hypot(best.x[0] - worst.x[0], best.x[1] - worst.x[1]);
        if (size < 1e-4 || (size < 0.03 && worst.cost - best.cost < 1e-5 * best.cost)) break;
        const auto away = [&](double factor) {
            std::array<double, 2> x;
            for (std::size_t j = 0; j < 2; ++j) {
                double centre = 0;
                for (std::size_t k = 0; k < n; ++k) centre += simplex[k].x[j] / double(n);
                x[j] = centre + factor * (centre - worst.x[j]);
            }
            return at(x);
        };
        const Point mirrored = away(1);
        if (mirrored.cost < best.cost) {
            const Point farther = away(2);
            worst = farther.cost < mirrored.cost ? farther : mirrored;
            continue;
        }
        if (mirrored.cost < last_but_one.cost) {
            worst = mirrored;
            continue;
        }
        const Point nearer = away(mirrored.cost < worst.cost ? 0.5 : -0.5);
        if (nearer.cost < std::min(mirrored.cost, worst.cost)) {
            worst = nearer;
            continue;
        }
        for (std::size_t k = 1; k <= n; ++k)
            simplex[k] = at({(simplex[k].x[0] + best.x[0]) / 2, (simplex[k].x[1] + best.x[1]) / 2});
    }
    return *std::min_element(simplex.begin(), simplex.end(), lower);
}

struct Answer {
    double Kp = 0, Ti = 0, Td = 0, iae = INFINITY;
};

Answer design(Plant plant, bool pi, const Effort& effort) {
    const double w = phase_crossover(plant);
    plant.count_time_in(w);
    const Design problem(plant, effort);
    const auto shape_at = [&](const std::array<double, 2>& x) {
        return Shape{std::exp(x[0]), pi ? 0 : std::exp(x[1])};
    };
    const auto cost = [&](const std::array<double, 2>& x) { return problem.cost(shape_at(x)); };
    const auto around = [&](const std::array<double, 2>& x, double step) {
        std::vector<Point> corners = {Point{x}, Point{{x[0] + step, x[1]}}};
        if (!pi) corners.push_back(Point{{x[0], x[1] + step}});
        return corners;
    };
    const Shape start = problem.start(pi);
    std::array<double, 2> from = {std::log(start.Ti), pi ? 0 : std::log(start.Td)};
    Point best{from};
    for (int i = 0; i < effort.starts; ++i, from[1] += pi ? 0 : std::log(0.1)) {  // next at a tenth of Td
        const Point found = nelder_mead(cost, around(from, std::log(0.4)));
        if (found.cost < best.cost) best = found;
    }
    best = nelder_mead(cost, around(best.x, 0.1));  // a simplex may have come to rest too early
    const Shape shape = shape_at(best.x);
    return {problem.gain(shape), shape.Ti / w, shape.Td / w, best.cost / w};
}

std::vector<double> ascending(const std::string& text) {
    std::istringstream in(text);
    std::vector<double> values;
    for (double value; in >> value;) values.insert(values.begin(), value);
    return values;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string(argv[argc - 1]) == "--version") return std::printf("g++ %s\n", __VERSION__), 0;
    const auto asked = [&](const std::string& word) { return std::find(argv + 1, argv + argc, word) != argv + argc; };
    const bool pi = asked("pi");
    const Effort effort = !asked("exact") ? Effort{} : pi ? kExactPi : kExactPid;
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream fields(line);
        std::string name, num, den, L;
        for (auto* field : {&name, &num, &den, &L}) std::getline(fields, *field, '\t');
        const Plant plant = {ascending(num), ascending(den), std::stod(L)};
        Answer answer;
        double best = INFINITY;
        for (int run = 0; run < kRuns; ++run) {
            const auto start = std::chrono::steady_clock::now();
            answer = design(plant, pi, effort);
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
            best = std::min(best, took.count());
        }
        if (std::isfinite(answer.iae))
            std::printf("%s\t%.12g\t%.12g\t%.12g\t%.6g\t%.9g\n", name.c_str(), answer.Kp, answer.Ti, answer.Td, best,
                        answer.iae);
    }
}
