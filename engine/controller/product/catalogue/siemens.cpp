// Siemens: PID_Compact of S7-1200/1500, FB41 CONT_C of S7-300/400.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

Product pid_compact() {
    return {
        .id = "siemens_pid_compact",
        .maker = "Siemens",
        .name = "PID_Compact (S7-1200/1500)",
        .families = {"S7-1200", "S7-1500", "TIA Portal", "TIA"},
        .form = Form::ideal,
        .law =
            "y = Gain [ (PWeighting w - x) + (1/(Ti s)) (w - x) + (Td s/(TdFiltRatio Td s + 1)) (DWeighting w - x) ]",
        .gain_basis = "output in percent per unit of the measurement",
        .parameters =
            {
                {.name = "Gain",
                 .label = "Retain.CtrlParams.Gain",
                 .unit = "%/unit of PV",
                 .role = ParameterRole::gain,
                 .term = kKp,
                 .range = {0, kUnbounded},
                 .standard = 1.0},
                {.name = "Ti",
                 .label = "Retain.CtrlParams.Ti",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded},
                 .standard = 20.0,
                 .off = 0.0,
                 .remark = "0 switches integral action off; it is not a fast integral."},
                {.name = "Td",
                 .label = "Retain.CtrlParams.Td",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded},
                 .standard = 0.0},
                {.name = "TdFiltRatio",
                 .label = "Retain.CtrlParams.TdFiltRatio",
                 .role = ParameterRole::filter,
                 .term = kFilterRatio,
                 .range = {0, kUnbounded},
                 .standard = 0.2,
                 .remark = "At 0 the derivative still acts for one cycle."},
                {.name = "PWeighting",
                 .label = "Retain.CtrlParams.PWeighting",
                 .role = ParameterRole::weight_b,
                 .shape = Shape::weight,
                 .range = kShare,
                 .standard = 1.0},
                {.name = "DWeighting",
                 .label = "Retain.CtrlParams.DWeighting",
                 .role = ParameterRole::weight_c,
                 .shape = Shape::weight,
                 .range = kShare},
            },
        .in_percent = true,
        .filter = {FilterKind::parameter, 0, "First order, T1 = TdFiltRatio Td."},
        .weights = {1, 0, "PWeighting and DWeighting can have any value."},
        .action = {.kind = Action::Kind::switched,
                   .name = "InvertControl",
                   .direct = true,
                   .reverse = false,
                   .text = "Config.InvertControl inverts the direction; Gain stays positive."},
        .algorithm = {.published = false,
                      .text = "position algorithm, PIDT1",
                      .anti_windup = "built in; the rule is not published",
                      .sample_time_text = "The tuner chooses the PID cycle, a multiple of the call cycle."},
        .traps = {"Ti = 0 means no integral action.",
                  "The tuner rounds the PID cycle to whole call cycles, which changes the sampled loop."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"equation", "names of the parameters", "defaults except for DWeighting",
                              "rule of inversion"},
                     .unverified = {"default of DWeighting", "unit of Gain", "discrete algorithm"},
                     .sources = {"S7-1200 Easy Book / System Manual 04/2012",
                                 "S7-1500 function manual A5E35300227-AC 03/2017, pp. 261, 284",
                                 "docs.tia.siemens.cloud V20, PID_Compact V1, control mode"}},
        .example = of_design_a({{"Gain", 1.5},
                                {"Ti", 120.0},
                                {"Td", 20.0},
                                {"TdFiltRatio", 0.1},
                                {"PWeighting", 0.6},
                                {"DWeighting", 0.0}}),
        .snippets = {{"SCL, for the instance PID_Compact_1",
                      "\"PID_Compact_1\".Retain.CtrlParams.Gain := {Gain};\n"
                      "\"PID_Compact_1\".Retain.CtrlParams.Ti := {Ti};\n"
                      "\"PID_Compact_1\".Retain.CtrlParams.Td := {Td};\n"
                      "\"PID_Compact_1\".Retain.CtrlParams.TdFiltRatio := {TdFiltRatio};\n"
                      "\"PID_Compact_1\".Retain.CtrlParams.PWeighting := {PWeighting};\n"
                      "\"PID_Compact_1\".Retain.CtrlParams.DWeighting := {DWeighting};\n"
                      "\"PID_Compact_1\".Config.InvertControl := {InvertControl=true:TRUE/FALSE};"}},
    };
}

// ---- FB41

/// The largest TIME: T#24D_20H_31M_23S_647MS.
constexpr double kMaxTime_s = 2147483.647;

Product fb41() {
    return {
        .id = "siemens_fb41_cont_c",
        .maker = "Siemens",
        .name = "FB41 CONT_C (S7-300/400)",
        .families = {"Step 7", "S7-300", "S7-400", "Simatic Manager"},
        .form = Form::ideal,
        .law = "LMN = GAIN [ 1 + 1/(TI s) + TD s/(TM_LAG s + 1) ] (SP - PV)",
        .gain_basis = "percent of span; with PV_FAC and PV_OFF also engineering units",
        .parameters =
            {
                {.name = "GAIN", .label = "GAIN", .unit = "%/%", .role = ParameterRole::gain, .term = kKn},
                {.name = "TI_s",
                 .label = "TI",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0.001, kMaxTime_s},
                 .resolution = 0.001,
                 .off = 0.0,
                 .remark = "a TIME, in steps of 1 ms"},
                {.name = "TD_s",
                 .label = "TD",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kMaxTime_s},
                 .resolution = 0.001},
                {.name = "TM_LAG_s",
                 .label = "TM_LAG",
                 .unit = "s",
                 .role = ParameterRole::filter,
                 .term = kTf,
                 .range = {0, kMaxTime_s},
                 .resolution = 0.001},
                fixed_choice("P_SEL", "P_SEL", true, "FALSE switches the proportional part off."),
                {.name = "I_SEL",
                 .label = "I_SEL",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = true, .integral = true}, {.value = false, .integral = false}},
                 .remark = "FALSE switches the integral part off."},
                {.name = "D_SEL",
                 .label = "D_SEL",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = false, .derivative = false}, {.value = true, .derivative = true}},
                 .remark = "The derivative part is off unless this is TRUE."},
            },
        .filter = {FilterKind::parameter, 0, "First order with its own time constant, TM_LAG."},
        .weights = {1, 1, "All three parts act on the error."},
        .action = kSigned,
        .algorithm = {.published = false,
                      .text = "position algorithm of three parallel parts",
                      .anti_windup = "the integral is held at the limits of LMN (unverified)",
                      .sample_time_text = "CYCLE, which must equal the interval of the calling organisation block."},
        .traps = {"D_SEL is FALSE by default: TD alone does nothing.",
                  "A call interval other than CYCLE scales Ti and Td by the ratio.",
                  "The proportional part acts on the set point: a step of it makes the output jump."},
        .evidence =
            {.level = EvidenceLevel::partly,
             .read = {"position algorithm, parallel parts, percent, dead band and switches, of a call compatible "
                      "block",
                      "transfer function with TM_LAG, of a third party",
                      "names, types and defaults of the parameters, of a third party",
                      "spelling of times with decimals in SCL", "range of a TIME"},
             .unverified = {"Siemens' own text about the block", "limits of TM_LAG against CYCLE",
                            "TI = 0 as integral off"},
             .sources = {"VIPA SPEED7 manual pp. 839-840 (call compatible FB41)",
                         "industrialmonitordirect.com, Siemens FB41 TM_LAG (third party)",
                         "blog.csdn.net 112944724, table of the parameters of FB41 (third party)",
                         "S7-SCL manual, simple time format (TIME#45.12M, T#300MS)",
                         "S7-1200 system manual A5E02486680, 4.4.4 (TIME: 32 bits with a sign, in ms)",
                         "SIMATIC PID Control C79000-G7076-C516 (its text could not be read)"}},
        .example = of_design_a({{"GAIN", 3.0},
                                {"TI_s", 120.0},
                                {"TD_s", 20.0},
                                {"TM_LAG_s", 2.0},
                                {"P_SEL", true},
                                {"I_SEL", true},
                                {"D_SEL", true}}),
        .snippets = {{"SCL of STEP 7, for the instance CONT_C_DB",
                      "\"CONT_C_DB\".GAIN := {GAIN};\n"
                      "\"CONT_C_DB\".TI := T#{TI_s}S;\n"
                      "\"CONT_C_DB\".TD := T#{TD_s}S;\n"
                      "\"CONT_C_DB\".TM_LAG := T#{TM_LAG_s}S;\n"
                      "\"CONT_C_DB\".P_SEL := {P_SEL=true:TRUE/FALSE};\n"
                      "\"CONT_C_DB\".I_SEL := {I_SEL=true:TRUE/FALSE};\n"
                      "\"CONT_C_DB\".D_SEL := {D_SEL=true:TRUE/FALSE};"}},
    };
}

}  // namespace

std::vector<Product> siemens_products() { return {pid_compact(), fb41()}; }

}  // namespace tunewright::product
