// Schneider Electric: PIDFF of EcoStruxure Control Expert in its two structures.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kMilliseconds = 0.001;  // seconds in one step of the type TIME

Parameter gain() {
    return {.name = "kp",
            .label = "kp",
            .unit = "output per PV unit",
            .role = ParameterRole::gain,
            .term = kKp,
            .range = {0, kUnbounded}};
}
Parameter time_of(std::string_view name, std::string_view label, ParameterRole role, Term term) {
    const bool integral = role == ParameterRole::integral;
    return {.name = name,
            .label = label,
            .unit = "s",
            .role = role,
            .term = term,
            .range = {integral ? kMilliseconds : 0, kUnbounded},
            .resolution = kMilliseconds,
            .off = integral ? std::optional(0.0) : std::nullopt,
            .remark = integral ? "0: the absolute algorithm, without integral action" : ""};
}
Parameter filter_gain(Term term) {
    return {.name = "kd",
            .label = "kd",
            .role = ParameterRole::filter,
            .term = term,
            .range = {0, kUnbounded},
            .remark = "the largest gain of the derivative (assumed)"};
}
Parameter attenuation() {
    return {.name = "ovs_att",
            .label = "ovs_att",
            .role = ParameterRole::weight_b,
            .shape = Shape::one_minus_b,
            .range = kShare,
            .standard = 0.0,
            .remark = "1 minus the weight of the set point, not the weight"};
}
Parameter derivative_of() {
    return {.name = "pv_dev",
            .label = "pv_dev",
            .role = ParameterRole::choice,
            .shape = Shape::option,
            .options = {{.value = std::string("PV"), .c = 0}, {.value = std::string("deviation"), .c = 1}},
            .remark = "0: of the measurement; 1: of the deviation"};
}

Product pidff() {
    return {
        .maker = "Schneider",
        .families = {"Modicon M340", "M580", "Quantum", "Unity Pro", "Control Expert"},
        .filter = {FilterKind::parameter, 0, "First order, td/kd (assumed: the printed function is a picture)."},
        .weights = {1, 0, "b is 1 - ovs_att, and pv_dev chooses the input of the derivative."},
        .action = {.kind = Action::Kind::switched,
                   .name = "rev_dir",
                   .direct = true,
                   .reverse = false,
                   .text = "rev_dir sets the direction."},
        .algorithm = {.velocity = true,
                      .published = false,
                      .text = "incremental for ti > 0, absolute for ti = 0; the derivative is a filtered difference",
                      .anti_windup = "aw_type, an extended anti-windup, RCPY as external integral",
                      .sample_time_text = "the task's period"},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"K = kp when mixed, output range over PV range when parallel",
                              "set point weighted by 1 - ovs_att", "incremental for ti > 0", "RCPY"},
                     .unverified = {"transfer function", "filter by kd", "whether kp is physical or normalised"},
                     .sources = {"Control Expert help, clclib D-SG-0011270, 0011271, 0011273, 0011275",
                                 "Control Expert help, procctlp D-SA-0008605"}},
    };
}

Product mixed() {
    Product product = pidff();
    product.id = "schneider_pidff_mixed";
    product.name = "PIDFF, mixed structure (mix_par 0), Control Expert";
    product.form = Form::ideal;
    product.law = "out = kp [ ((1 - ovs_att) SP - PV) + (1/(ti s)) (SP - PV) + (td s/((td/kd) s + 1)) (c SP - PV) ]";
    product.gain_basis = "output unit per unit of the measurement (assumed)";
    product.parameters = {gain(),
                          time_of("ti_s", "ti", ParameterRole::integral, kTi),
                          time_of("td_s", "td", ParameterRole::derivative, kTd),
                          filter_gain(kFilterGain),
                          fixed_choice("mix_par", "mix_par", 0.0, "0: the mixed structure"),
                          attenuation(),
                          derivative_of()};
    product.traps = {"ovs_att is 1 - b, not b."};
    product.example = of_design_a({{"kp", 1.5},
                                   {"ti_s", 120.0},
                                   {"td_s", 20.0},
                                   {"kd", 10.0},
                                   {"mix_par", 0.0},
                                   {"ovs_att", 0.4},
                                   {"pv_dev", std::string("PV")}});
    return product;
}

Product parallel() {
    Product product = pidff();
    product.id = "schneider_pidff_parallel";
    product.name = "PIDFF, parallel structure (mix_par 1), Control Expert";
    product.form = Form::parallel;
    product.law =
        "out = kp ((1 - ovs_att) SP - PV) + q [ (1/(ti s)) (SP - PV) + (td s/((td/kd) s + 1)) (c SP - PV) ], "
        "q = Su/Sy";
    product.gain_basis = "P in engineering units, I and D by the ratio of the ranges";
    product.parameters = {gain(),
                          time_of("ti_s", "ti", ParameterRole::integral, {.Kp = -1, .Ti = 1, .Sy = -1, .Su = 1}),
                          time_of("td_s", "td", ParameterRole::derivative, of_spans(kKd)),
                          filter_gain(of_spans({.Kp = 1, .Td = 1, .Tf = -1})),
                          fixed_choice("mix_par", "mix_par", 1.0, "1: the parallel structure"),
                          attenuation(),
                          derivative_of()};
    product.traps = {"A change of kp leaves I and D as they are."};
    product.example = of_design_a({{"kp", 1.5},
                                   {"ti_s", 40.0},
                                   {"td_s", 60.0},
                                   {"kd", 30.0},
                                   {"mix_par", 1.0},
                                   {"ovs_att", 0.4},
                                   {"pv_dev", std::string("PV")}});
    return product;
}

}  // namespace

std::vector<Product> schneider_products() { return {mixed(), parallel()}; }

}  // namespace tunewright::product
