// Made by generate_contract.mjs from the service's /openapi.json; not to be edited.
export type components = {
  schemas: {
    Problem: {
      type: string;
      title: string;
      status: number;
      detail: string;
      instance?: string;
      errors?: components["schemas"]["Fault"][];
      cure?: {
        text: string;
        options: {
          [key: string]: number;
        };
      };
      record?: {
        samples: number;
        t: number[];
        u: number[];
        y: number[];
        r?: number[];
        move_times: number[];
      };
    };
    Fault: {
      pointer: string;
      detail: string;
    };
    JobStatus: "queued" | "running" | "succeeded" | "failed" | "cancelled";
    Progress: {
      fraction: number;
      stage: string;
      message: string;
      best?: {
        controller?: components["schemas"]["Controller"];
        load_IAE?: number | null;
        Ms?: number | null;
        Mt?: number | null;
      } | null;
    };
    JobSummary: {
      id: string;
      name: string | null;
      owner?: string;
      status: components["schemas"]["JobStatus"];
      batch?: string;
      index?: number;
      created_at: string;
      started_at?: string | null;
      finished_at?: string | null;
      attempts?: number;
      not_before?: string;
      outline?: components["schemas"]["JobOutline"];
      links?: {
        [key: string]: string;
      };
    };
    JobOutline: {
      plant?: {
        type: string;
      } & {
        [key: string]: unknown;
      };
      record?: boolean;
      units?: {
        [key: string]: string;
      };
      entries?: number;
      method?: string;
      controller?: components["schemas"]["Controller"];
      to_type?: {
        [key: string]: string;
      };
      Ms?: number | null;
      worst_Ms?: number | null;
      load_IAE?: number | null;
      excess_percent?: number | null;
      today?: {
        controller?: components["schemas"]["Controller"];
        to_type?: {
          [key: string]: string;
        };
        Ms?: number | null;
        load_IAE?: number | null;
      };
      range?: {
        scheduling?: string;
        points?: number;
        rows?: number;
      };
      check?: {
        loops?: number;
        tag?: string;
        verdict?: string;
        action?: string;
      };
      structure?: {
        verdict?: string[];
      };
      error?: string;
    };
    Job: {
      id: string;
      name: string | null;
      status: components["schemas"]["JobStatus"];
      batch?: string;
      index?: number;
      progress?: components["schemas"]["Progress"] | null;
      created_at: string;
      started_at?: string | null;
      finished_at?: string | null;
      attempts?: number;
      not_before?: string;
      outline?: components["schemas"]["JobOutline"];
      request: components["schemas"]["TuningRequest"] | components["schemas"]["RangeRequest"] | components["schemas"]["CheckRequest"] | components["schemas"]["CascadeRequest"] | components["schemas"]["LevelRequest"] | components["schemas"]["FeedforwardRequest"] | components["schemas"]["InteractionRequest"] | components["schemas"]["PredictorRequest"] | null;
      result?: components["schemas"]["TuningResult"] | components["schemas"]["RangeResult"] | components["schemas"]["CheckResult"] | components["schemas"]["CascadeAnswer"] | components["schemas"]["LevelAnswer"] | components["schemas"]["FeedforwardAnswer"] | components["schemas"]["InteractionAnswer"] | components["schemas"]["PredictorAnswer"];
      error?: components["schemas"]["Problem"];
      partial?: boolean;
      links?: {
        [key: string]: string;
      };
    };
    JobList: {
      jobs: components["schemas"]["JobSummary"][];
      next: string | null;
    };
    Batch: {
      id: string;
      name: string | null;
      status: "receiving" | "queued" | "running" | "ended";
      total: number;
      counts: {
        queued: number;
        running: number;
        succeeded: number;
        failed: number;
        cancelled: number;
      };
      progress: {
        fraction: number;
      };
      cancel_requested: boolean;
      created_at: string;
      finished_at: string | null;
      notes?: string[];
      links: {
        [key: string]: string;
      };
    };
    MethodDescription: {
      id: string;
      title: string;
      formula: string;
      formula_mathml: string;
      needs: string;
      validity: string;
      source: string;
      options: {
        [key: string]: unknown;
      };
    };
    Example: {
      id: string;
      title: string;
      description: string;
      request: components["schemas"]["TuningRequest"];
    };
    RangeExample: {
      id: string;
      title: string;
      description: string;
      request: components["schemas"]["RangeRequest"];
    };
    Health: {
      status: string;
      version?: string;
      max_body_bytes?: number;
      retention_s?: number;
    };
    TuningRequest: {
      name?: string;
      units?: components["schemas"]["Units"];
      plant?: components["schemas"]["PlantModel"] | components["schemas"]["TypedPlant"];
      record?: components["schemas"]["Record"];
      ultimate?: components["schemas"]["UltimateTest"];
      identify?: components["schemas"]["Identify"];
      tune?: components["schemas"]["Method"][] | "all";
      controllers?: (components["schemas"]["Controller"] | components["schemas"]["TypedSettings"] | components["schemas"]["TypedController"])[];
      baseline?: components["schemas"]["Controller"] | components["schemas"]["TypedSettings"] | components["schemas"]["TypedController"] | "from-record";
      implement?: components["schemas"]["Implement"];
      evaluate?: components["schemas"]["Evaluate"];
      uncertainty?: "auto" | "none" | "identified";
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
    };
    Units: {
      time?: string;
      u?: string;
      y?: string;
    };
    PlantModel: {
      type: string;
    } & {
      [key: string]: unknown;
    };
    Plant: {
      type: string;
    } & {
      [key: string]: unknown;
    };
    TypedPlant: string;
    Record: {
      t?: number[];
      dt?: number;
      u?: number[];
      y?: number[];
      r?: number[];
      mode?: string[];
      d?: components["schemas"]["MeasuredDisturbance"][];
      csv?: string;
      columns?: components["schemas"]["Columns"];
      time_unit?: string;
      kind?: "auto" | "step" | "several_steps" | "relay" | "general";
      u0?: number;
      y0?: number;
      u_limits?: [
        number,
        number
      ];
      u_step?: [
        number,
        number
      ];
      run?: number;
      from?: number;
      to?: number;
    };
    MeasuredDisturbance: {
      name: string;
      values: number[];
    };
    Columns: {
      t?: string | number;
      u?: string | number;
      y?: string | number;
      r?: string | number;
      mode?: string | number;
      d?: (string | number)[];
    };
    UltimateTest: {
      Ku: number;
      Pu: number;
      K?: number;
    };
    Identify: {
      model?: "auto" | "fopdt" | "sopdt" | "sopdt_zero" | "ipdt" | "ipdt_lag";
      method?: "auto" | "output_error" | "relay_fourier" | "two_point";
      shift?: number;
      traces?: boolean;
    };
    Method: {
      method: string;
    } & {
      [key: string]: unknown;
    };
    Controller: {
      form: "ideal" | "parallel" | "series" | "npid";
      Kp: number;
      Ti?: (number | null) | number;
      Td?: number;
      setpoint_filter?: components["schemas"]["SetpointFilter"];
      b: number | 1;
      c: number | 0;
      filter: components["schemas"]["Filter"];
      action: "reverse" | "direct";
      Ki?: number;
      Kd?: number;
      b_equivalent?: number;
      delta_r?: number;
    };
    SetpointFilter: {
      T: number;
    };
    Filter: {
      type: "none" | "derivative" | "measurement_first_order" | "measurement_second_order";
      Tf?: number;
      N?: number;
    };
    ParallelController: {
      form: "parallel";
      Kp: number;
      Ki: number;
      Kd: number;
      setpoint_filter?: components["schemas"]["SetpointFilter"];
      b: number;
      c: number;
      filter: components["schemas"]["Filter"];
      action: "reverse" | "direct";
    };
    SeriesController: {
      form: "series";
      Kp: number;
      Ti: number | null;
      Td: number;
      setpoint_filter?: components["schemas"]["SetpointFilter"];
      b: number;
      c: number;
      filter: components["schemas"]["Filter"];
      action: "reverse" | "direct";
      b_equivalent: number;
    };
    TypedSettings: {
      product: string;
      settings: {
        [key: string]: number | string | boolean;
      };
      y_span?: [
        number,
        number
      ];
      u_span?: [
        number,
        number
      ];
      sample_time?: number;
    };
    TypedController: string;
    Implement: {
      product?: string;
      y_span?: [
        number,
        number
      ];
      u_span?: [
        number,
        number
      ];
      sample_time?: number;
      integral?: "backward" | "forward" | "trapezoidal";
      derivative?: "backward" | "filtered";
      algorithm?: "position" | "velocity";
      computation_delay?: number;
      u_resolution?: number;
      y_resolution?: number;
      dead_band?: number;
    };
    Evaluate: {
      setpoint_step?: number;
      load_step?: number;
      horizon?: "auto" | number;
      points?: number;
      actuator?: components["schemas"]["Actuator"];
      noise?: components["schemas"]["Noise"];
      own_step?: components["schemas"]["OwnStep"];
      tradeoff?: boolean;
      rank_limits?: {
        Ms?: number;
      };
      optimum_at_Ms?: boolean;
    };
    Actuator: {
      min: number;
      max: number;
    };
    Noise: {
      std?: number;
      sample_time?: number;
    };
    OwnStep: {
      y?: number;
      u?: number;
      target: number;
      u_min?: number;
      u_max?: number;
      ramp_rate?: number;
      hold?: number;
      load?: components["schemas"]["OwnLoad"];
      length?: number;
    };
    OwnLoad: {
      size: number;
      at?: "input" | "output";
      shape?: "step" | "pulse" | "ramp";
      duration?: number;
    };
    Notify: {
      url: string;
      secret_id?: string;
    };
    TuningResult: {
      units?: components["schemas"]["Units"];
      model?: components["schemas"]["Model"];
      replay?: components["schemas"]["ReplayedRecord"];
      operating_point?: components["schemas"]["OperatingPoint"];
      linear_model?: components["schemas"]["Plant"];
      controllers: components["schemas"]["Entry"][];
      verdict: components["schemas"]["Finding"][];
      ranking: number[];
      ranking_by: string;
      rank_limits?: {
        Ms: number;
      };
      proposed?: number;
      partial: boolean;
      version: string;
      request_hash: string;
      seed: number;
    };
    Model: {
      plant: components["schemas"]["Plant"];
      fit_percent: number;
      grade: "good" | "usable" | "doubtful";
      grade_reason?: "fit" | "warning";
      standard_errors: {
        [key: string]: number | null;
      };
      covariance?: components["schemas"]["Covariance"];
      alternatives: components["schemas"]["Plant"][];
      disturbances?: components["schemas"]["Disturbance"][];
      limit_cycle?: components["schemas"]["LimitCycle"];
      frequency_points?: components["schemas"]["FrequencyPoint"][];
      ultimate_point?: components["schemas"]["UltimatePoint"];
      excited_band?: components["schemas"]["ExcitedBand"];
      region?: components["schemas"]["Region"];
      choice_reason: string;
      candidates: components["schemas"]["Candidate"][];
      fit?: components["schemas"]["Fit"];
      data_quality: components["schemas"]["DataQuality"];
      warnings: components["schemas"]["Warning"][];
    };
    Covariance: {
      names: string[];
      matrix: number[][];
      reach?: number[];
    };
    Disturbance: {
      name: string;
      plant: components["schemas"]["Plant"];
      standard_errors: {
        [key: string]: number | null;
      };
      share: number;
    };
    LimitCycle: {
      Pu: number;
      Au: number;
      phi_u: number;
      periods: number;
      shift?: components["schemas"]["ShiftedPoint"];
      fit_rms?: number;
      describing_function?: components["schemas"]["UltimatePoint"];
      t_plus?: number;
      t_minus?: number;
      y_max?: number;
      y_min?: number;
    };
    ShiftedPoint: {
      sigma: number;
      A: number;
      phi: number;
    };
    UltimatePoint: {
      Ku: number;
      Pu: number;
    };
    FrequencyPoint: {
      omega: number;
      re: number;
      im: number;
      std: number;
    };
    ExcitedBand: {
      omega_low: number;
      omega_high: number;
    };
    Region: {
      stable_fraction: number;
      worst_Ms: number | null;
      worst_plant: components["schemas"]["Plant"];
      why_null?: {
        [key: string]: string;
      };
    };
    Candidate: {
      plant: components["schemas"]["Plant"];
      fit_percent: number;
      criterion: number;
      standard_errors: {
        [key: string]: number | null;
      };
      undetermined?: string[];
      much_worse?: boolean;
      y_model?: (number | null)[];
    };
    Fit: {
      t: number[];
      u: (number | null)[];
      y: (number | null)[];
      y_model: (number | null)[];
    };
    DataQuality: {
      kind: "step" | "several_steps" | "relay" | "general";
      test: string;
      samples: number;
      samples_dropped: number;
      sample_time: number;
      irregular: boolean;
      noise_std: number;
      quantisation: number;
      steps: number;
      move_times: number[];
      cycles?: number;
      settled: boolean;
      u0: number;
      y0: number;
      u_limits?: [
        number,
        number
      ];
      pretest?: components["schemas"]["PreTest"];
      gaps?: components["schemas"]["MissingPart"];
      missing?: components["schemas"]["MissingPart"];
      repeated_times: number;
      backward_times: number;
      time_unit_assumed?: boolean;
      saturation?: components["schemas"]["Saturation"][];
      backlash?: number;
      outliers?: components["schemas"]["Outliers"];
      closed_loop?: components["schemas"]["ClosedLoop"];
      notes: string[];
    };
    PreTest: {
      samples: number;
      duration: number;
      drift: number;
      at_rest: boolean;
    };
    MissingPart: {
      count: number;
      longest: number;
      at: number;
    };
    Saturation: {
      level: number;
      fraction: number;
    };
    Outliers: {
      count: number;
      rows: number[];
    };
    ClosedLoop: {
      evidence: string;
      used: "set_point" | "switched_on" | "outside_moves" | "none";
      share: number;
      set_point_moves?: number;
    };
    Warning: {
      code: string;
      detail: string;
      level: "warning" | "bad";
    };
    ReplayedRecord: {
      refused?: {
        code: "manual" | "feedback" | "no-set-point" | "doubtful-model" | "unknown-region" | "no-error";
        text: string;
      };
      from?: number;
      to?: number;
      figures?: components["schemas"]["ReplayFigures"];
      t?: number[];
      r?: (number | null)[];
      y?: (number | null)[];
      u?: (number | null)[];
    };
    ReplayFigures: {
      IAE: number;
      largest_error: number;
      travel: number;
      reversals: number;
    };
    OperatingPoint: {
      states: {
        [key: string]: number;
      };
      u: number;
      y: number;
    };
    Entry: {
      method?: string;
      title?: string;
      source?: string;
      options?: {
        [key: string]: unknown;
      };
      over_region?: boolean;
      region_cost?: number;
      verdict: components["schemas"]["Finding"][];
      warnings?: components["schemas"]["Warning"][];
      reduced_model?: components["schemas"]["Plant"];
      controller?: components["schemas"]["Controller"];
      equivalents?: components["schemas"]["Equivalents"];
      robustness?: components["schemas"]["Robustness"];
      nonlinear?: components["schemas"]["Nonlinear"];
      performance?: components["schemas"]["Performance"];
      responses?: components["schemas"]["Responses"];
      linear?: components["schemas"]["StepResponse"];
      frequency?: components["schemas"]["Frequency"];
      verification?: components["schemas"]["Verification"];
      region?: components["schemas"]["Region"];
      longest_sample_time?: number | null;
      as_entered?: components["schemas"]["SettingsAnswer"];
      implemented?: components["schemas"]["Implemented"];
      surface?: components["schemas"]["CostSurface"];
      certificate?: components["schemas"]["Certificate"];
      frontier?: components["schemas"]["Frontier"];
      rimc?: components["schemas"]["Rimc"];
      optimum_at_Ms?: components["schemas"]["OptimumAtMs"];
      replay?: components["schemas"]["ReplayedEntry"];
      own_step?: components["schemas"]["OwnStepEntry"];
      standing?: components["schemas"]["Standing"];
      tradeoff?: components["schemas"]["Tradeoff"];
      emulation?: components["schemas"]["Emulation"];
      compute_ms?: number;
      error?: components["schemas"]["Problem"];
    };
    Finding: {
      code: string;
      level: "good" | "note" | "warning" | "bad";
      text: string;
      figures: {
        [key: string]: number | null;
      };
    };
    Equivalents: {
      parallel: components["schemas"]["ParallelController"];
      series: components["schemas"]["SeriesController"] | null;
      why_null?: {
        [key: string]: string;
      };
    };
    Robustness: {
      stable: boolean;
      Ms: number | null;
      omega_Ms: number | null;
      Mt: number | null;
      omega_Mt: number | null;
      Mks: number | null;
      gain_margin: number | null;
      gain_margin_low: number | null;
      phase_margin_deg: number | null;
      delay_margin: number | null;
      gain_crossover: number | null;
      phase_crossover: number | null;
      binding?: string;
      tolerates: {
        gain: [
          number | null,
          number | null
        ];
        extra_dead_time: number | null;
        why_null?: {
          [key: string]: string;
        };
      };
      why_null?: {
        [key: string]: string;
      };
    };
    Nonlinear: {
      delta_r: number;
      sector: [
        number,
        number
      ];
      stable_without_integral: boolean;
      circle_criterion: boolean;
      popov_criterion: boolean;
      popov_q: number | null;
      limit_cycle_predicted: boolean;
      limit_cycle_amplitude: number | null;
      limit_cycle_omega: number | null;
      statement: string;
      why_null?: {
        [key: string]: string;
      };
    };
    Performance: {
      setpoint: components["schemas"]["SetpointPerformance"];
      load: components["schemas"]["LoadPerformance"];
      noise?: components["schemas"]["NoisePerformance"];
    };
    SetpointPerformance: {
      IAE: number | null;
      ISE: number | null;
      ITAE: number | null;
      overshoot_percent: number | null;
      rise_time: number | null;
      rise_time_5_95: number | null;
      settling_time: number | null;
      TV: number | null;
      first_move: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    LoadPerformance: {
      IAE: number | null;
      ISE: number | null;
      ITAE: number | null;
      peak: number | null;
      recovery_time: number | null;
      TV: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    NoisePerformance: {
      u_std: number | null;
      gain: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    Responses: {
      setpoint: components["schemas"]["Trace"];
      load: components["schemas"]["Trace"];
      settles: boolean;
    };
    Trace: {
      t: number[];
      y: (number | null)[];
      u: (number | null)[];
    };
    StepResponse: {
      performance: components["schemas"]["Performance"];
      responses?: components["schemas"]["Responses"];
    };
    Frequency: {
      omega: number[];
      L: {
        re: (number | null)[];
        im: (number | null)[];
        phase_deg: (number | null)[];
      };
      S_abs: (number | null)[];
      T_abs: (number | null)[];
      CS_abs: (number | null)[];
    };
    Verification: {
      setpoint_errors: components["schemas"]["IndexErrors"];
      load_errors: components["schemas"]["IndexErrors"];
      iae_step_halving: number | null;
      load_error_keeps_sign: boolean | null;
      ie_identity: number | null;
      ms_grid_difference: number | null;
      stability_methods_agree: boolean | null;
      why_null?: {
        [key: string]: string;
      };
    };
    IndexErrors: {
      IAE: number | null;
      ISE: number | null;
      ITAE: number | null;
      TV: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    SettingsAnswer: {
      product: string;
      settings: {
        [key: string]: number | string | boolean;
      };
      units: {
        [key: string]: string;
      };
      as_typed: {
        [key: string]: string;
      };
      snippets?: components["schemas"]["Snippet"][];
      realised: components["schemas"]["Controller"];
      notes: components["schemas"]["SettingsNote"][];
      standard_errors?: {
        [key: string]: number | null;
      };
    };
    Snippet: {
      name: string;
      text: string;
    };
    SettingsNote: {
      code: string;
      detail: string;
      deviation: boolean;
    };
    Implemented: {
      sample_time: number | null;
      robustness: components["schemas"]["Robustness"];
      performance: components["schemas"]["Performance"];
      responses?: components["schemas"]["Responses"];
      region?: components["schemas"]["Region"];
      difference: components["schemas"]["Difference"];
    };
    Difference: {
      Ms_percent: number | null;
      load_IAE_percent: number | null;
      overshoot_points: number | null;
      differs: ("Ms" | "load_IAE" | "overshoot")[];
      why_null?: {
        [key: string]: string;
      };
    };
    CostSurface: {
      Ti: (number | null)[];
      Td: (number | null)[];
      cost: (number | null)[][];
    };
    Certificate: {
      upper: number;
      lower: number;
      gap: number;
      asked_gap: number;
      complete: boolean;
      root: {
        low: {
          k: number;
          ki: number;
          kd?: number;
          Td?: number;
        };
        high: {
          k: number;
          ki: number;
          kd?: number;
          Td?: number;
        };
      };
      boxes: number;
      problem: {
        plant: {
          num: number[];
          den: number[];
          L: number;
        };
        structure: "pi" | "pid_fixed" | "pid_tied";
        Tf: number;
        Ms: number;
        Mt: number;
        upper: number;
        design: number[];
      };
      seconds: number;
    };
    Frontier: {
      points: components["schemas"]["FrontierPoint"][];
      infeasible_below: number | null;
      compute_ms: number;
    };
    FrontierPoint: {
      Ms: number;
      controller: components["schemas"]["Controller"];
      load_IAE: number | null;
      setpoint_IAE: number | null;
      overshoot_percent: number | null;
      Mks: number | null;
      TV: number | null;
      achieved: {
        Ms?: number | null;
        Mt?: number | null;
      };
      why_null?: {
        [key: string]: string;
      };
    };
    Rimc: {
      lambda: number;
      Ms: number | null;
      disturbance_peak: number | null;
      dead_time_error: number | null;
      stability_limit: number | null;
      full_controller: components["schemas"]["FullController"] | null;
      disturbance_peak_curve?: components["schemas"]["DisturbancePeakCurve"];
      why_null?: {
        [key: string]: string;
      };
    };
    FullController: {
      robustness: components["schemas"]["Robustness"];
      load: components["schemas"]["LoadPerformance"];
      responses?: components["schemas"]["Responses"];
    };
    DisturbancePeakCurve: {
      lambda_over_tau: number[];
      DP_over_kp: (number | null)[];
      Ms: (number | null)[];
    };
    OptimumAtMs: {
      IAE: number | null;
      excess_percent: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    ReplayedEntry: {
      refused?: {
        code: "no-law" | "unstable" | "wide-band";
        text: string;
      };
      figures?: components["schemas"]["ReplayFigures"];
      IAE_ratio?: number;
      IAE_ratio_low?: number;
      IAE_ratio_high?: number;
      travel_ratio?: number;
      y?: (number | null)[];
      u?: (number | null)[];
    };
    OwnStepEntry: {
      refused?: {
        code: "no-time" | "equations" | "no-law" | "unstable" | "impulse";
        text: string;
      };
      setpoint?: components["schemas"]["OwnSetpointFigures"];
      load?: components["schemas"]["OwnLoadFigures"];
      u_min?: number;
      u_max?: number;
      travel?: number;
      time_at_min?: number | null;
      time_at_max?: number | null;
      u_needed?: number | null;
      y_final?: number | null;
      why_null?: {
        [key: string]: string;
      };
      settles?: boolean;
      trace?: components["schemas"]["OwnStepTrace"];
    };
    OwnSetpointFigures: {
      IAE: number | null;
      overshoot: number | null;
      overshoot_percent: number | null;
      settling_time: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    OwnLoadFigures: {
      start: number;
      IAE: number | null;
      peak: number | null;
      recovery_time: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    OwnStepTrace: {
      t: number[];
      r: (number | null)[];
      y: (number | null)[];
      u: (number | null)[];
    };
    Standing: {
      group: "holds" | "above_limit" | "not_settled" | "unstable";
      settles: boolean;
      Ms: number | null;
      within: boolean;
      excess_percent: number | null;
      order: number;
      least_limit: number | null;
      why?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    Tradeoff: {
      fopdt?: components["schemas"]["Plant"];
      constants?: string;
      Ms_design?: number;
      model: components["schemas"]["TradeoffFigures"];
      plant: components["schemas"]["TradeoffFigures"];
      profile?: components["schemas"]["TradeoffProfile"];
    };
    TradeoffFigures: {
      J_r: number | null;
      J_d: number | null;
      J_rd: number | null;
      J_r_opt: number | null;
      J_d_opt: number | null;
      I_perf: number | null;
      Deg: number | null;
      Ms: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    TradeoffProfile: {
      by_Ms: components["schemas"]["TradeoffAtMs"][];
      by_degradation: components["schemas"]["TradeoffAtLevel"][];
    };
    TradeoffAtMs: {
      Ms_design: number;
      Ms: number;
      J_r: number;
      J_d: number;
      J_rd: number;
      I_perf: number;
      Deg: number;
    };
    TradeoffAtLevel: {
      degradation: number;
      Ms: number;
      J_r: number;
      J_d: number;
      J_rd: number;
      I_perf: number;
      Deg: number;
    };
    Emulation: {
      formulation: string;
      J: number;
      J_y: number | null;
      J_u: number;
      weights: {
        wy?: number;
        wu?: number;
      };
      horizon: number;
      active_bounds: components["schemas"]["ActiveBound"][];
      bounds: {
        [key: string]: [
          number,
          number
        ];
      };
      flatness: {
        [key: string]: number | null;
      };
      flatness_alone: {
        [key: string]: number | null;
      };
      relative_degree: number;
      zero_dynamics_stable: boolean;
      zeros: (number | [
        number,
        number
      ])[];
      target: {
        beta?: number[];
      };
      fit: components["schemas"]["EmulationFit"];
      level1: components["schemas"]["LevelOneRow"][];
      scenarios: components["schemas"]["EmulatedScenario"][];
      t?: number[];
      y_nl?: (number | null)[];
      u_nl?: (number | null)[];
      why_null?: {
        [key: string]: string;
      };
    };
    ActiveBound: {
      parameter: string;
      bound: "low" | "high";
      value: number;
    };
    EmulationFit: {
      u_left: number;
      y_left: number;
      adequate: boolean;
      sentence: string;
    };
    LevelOneRow: {
      method: string;
      test: "step" | "relay" | "linear";
      title: string;
      model?: components["schemas"]["Plant"];
      controller?: components["schemas"]["Controller"];
      error?: string;
      J: number | null;
      ended?: string;
      t?: number[];
      y?: (number | null)[];
      u?: (number | null)[];
      why_null?: {
        [key: string]: string;
      };
    };
    EmulatedScenario: {
      setpoint_step: number;
      initial?: {
        [key: string]: number | null;
      };
      parameters?: {
        [key: string]: number | null;
      };
      y_rest: number;
      u_rest: number;
      limited: boolean;
      ended?: string;
      t?: number[];
      y_nl?: (number | null)[];
      u_nl?: (number | null)[];
      y?: (number | null)[];
      u?: (number | null)[];
    };
    DesignAnswer: {
      model?: components["schemas"]["Model"];
      replay?: components["schemas"]["ReplayedRecord"];
      operating_point?: components["schemas"]["OperatingPoint"];
      linear_model?: components["schemas"]["Plant"];
      controllers: components["schemas"]["Entry"][];
      verdict: components["schemas"]["Finding"][];
      ranking: number[];
      ranking_by: string;
      rank_limits?: {
        Ms: number;
      };
      proposed?: number;
    };
    CheckRequest: {
      name?: string;
      units?: components["schemas"]["Units"];
      loops: components["schemas"]["CheckLoop"][];
      cluster?: boolean;
      settings?: boolean;
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
    };
    CheckLoop: {
      tag?: string;
      kind?: "unknown" | "flow" | "pressure" | "level" | "temperature" | "composition";
      averaging?: boolean;
      range?: components["schemas"]["LoopRanges"];
      controller?: components["schemas"]["Controller"];
      weight?: number;
      record?: components["schemas"]["Record"];
      csv?: string;
      columns?: components["schemas"]["Columns"];
      time_unit?: string;
      start?: string;
      notes?: string[];
    };
    LoopRanges: {
      pv?: [
        number,
        number
      ];
      op?: [
        number,
        number
      ];
    };
    CheckResult: {
      loops: components["schemas"]["LoopCheck"][];
      clusters: components["schemas"]["LoopCluster"][];
      cascades: components["schemas"]["LoopCascade"][];
      ranking: components["schemas"]["LoopRank"][];
      partial: boolean;
      units?: components["schemas"]["Units"];
      version: string;
      request_hash: string;
      notes?: string[];
    };
    LoopCheck: {
      tag: string;
      quality: components["schemas"]["CheckedRecord"];
      service: components["schemas"]["LoopService"];
      oscillation: components["schemas"]["LoopOscillation"];
      cause: components["schemas"]["LoopCause"];
      performance: components["schemas"]["LoopPerformance"];
      action: components["schemas"]["CheckAction"];
      cure?: components["schemas"]["LoopCure"];
      weight?: number;
      trend: components["schemas"]["LoopTrend"];
      excerpt: components["schemas"]["LoopTrend"];
      spectrum: components["schemas"]["CheckCurve"];
      autocorrelation: components["schemas"]["CheckCurve"];
      shape: components["schemas"]["LoopShape"];
    };
    CheckedRecord: {
      rows: number;
      sample_time: number;
      duration: number;
      missing: number;
      held: number;
      longest_gap: number;
      noise: number;
      y_step: number;
      u_step: number;
      at_limit: number | null;
      compressed: boolean;
      enough: boolean;
      remarks: components["schemas"]["Warning"][];
      readings: string[];
      why_null?: {
        [key: string]: string;
      };
    };
    LoopService: {
      automatic: number | null;
      manual: number | null;
      saturated_low: number;
      saturated_high: number;
      output_still: number;
      longest_still: number;
      measurement_still: number;
      why_null?: {
        [key: string]: string;
      };
    };
    LoopOscillation: {
      found: boolean;
      period: number | null;
      regularity: number | null;
      periods: components["schemas"]["LoopPeriod"][];
    };
    LoopPeriod: {
      period: number;
      period_error: number;
      regularity: number;
      share: number;
      amplitude: number;
    };
    LoopCause: {
      verdict: "healthy" | "stiction" | "backlash" | "tight" | "sluggish" | "external" | "saturation" | "quantised" | "manual" | "frozen" | "undetermined" | "insufficient-data";
      confidence: "sure" | "likely" | "open";
      evidence: components["schemas"]["CheckEvidence"][];
      alternatives: ("healthy" | "stiction" | "backlash" | "tight" | "sluggish" | "external" | "saturation" | "quantised" | "manual" | "frozen" | "undetermined" | "insufficient-data")[];
      size: number | null;
      jump: number | null;
      period: number | null;
      why_open?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    CheckEvidence: {
      code: string;
      value: number;
      limit?: number;
      detail: string;
    };
    LoopPerformance: {
      harris: components["schemas"]["HarrisRange"] | null;
      idle_index: number | null;
      variability: number;
      variability_share: number | null;
      mean_error: number;
      independent: number;
      following: number | null;
      offset: number;
      travel: number | null;
      reversals: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    HarrisRange: {
      low: number;
      high: number;
      delays: [
        number,
        number
      ];
    };
    CheckAction: {
      code: "none" | "retune" | "repair-valve" | "find-source" | "return-to-automatic" | "check-range" | "check-transmitter" | "record-again" | "test";
      owner: "nobody" | "control" | "instruments" | "process" | "operations";
      detail: string;
    };
    LoopCure: {
      settings?: components["schemas"]["Controller"];
      today?: components["schemas"]["Controller"];
      plant?: components["schemas"]["Plant"];
      worst_Ms: number | null;
      error_ratio: number | null;
      test?: components["schemas"]["CheckTest"];
      valve?: components["schemas"]["CycleStops"];
      detail: string;
      why_null?: {
        [key: string]: string;
      };
    };
    CheckTest: {
      kind: "set-point-steps" | "output-steps";
      size: number;
      steps: number;
      hold: number;
      duration: number;
      beyond_seen: boolean;
      detail: string;
    };
    CycleStops: {
      outcome: "found" | "none" | "not-told";
      stops: components["schemas"]["CycleStop"][];
      plant?: components["schemas"]["Plant"];
      period: number | null;
      amplitude: number | null;
      recorded_amplitude: number;
      detail: string;
      why_null?: {
        [key: string]: string;
      };
    };
    CycleStop: {
      means: "integral-time" | "gap" | "no-integral";
      Kp: number;
      Ti?: number;
      gap: number;
      error_ratio: [
        number,
        number
      ];
      standing_error: number;
      detail: string;
    };
    LoopTrend: {
      t: number[];
      y: (number | null)[];
      r?: (number | null)[];
      u: (number | null)[];
    };
    CheckCurve: {
      x: number[];
      y: (number | null)[];
    };
    LoopShape: {
      from: number;
      to: number;
      dated: boolean;
      period: number;
      spectrum: number[];
      wave: number[];
      wave_from: number;
      wave_step: number;
      set_point: number[];
      output: number[];
    };
    LoopCluster: {
      period: number;
      loops: number[];
      source?: number;
      detail: string;
    };
    LoopCascade: {
      master: number;
      slave: number;
    };
    LoopRank: {
      loop: number;
      gain: number | null;
      share: number | null;
      money: number | null;
      effort: number;
      after?: number;
      why_null?: {
        [key: string]: string;
      };
    };
    BatchCheck: {
      loops: components["schemas"]["LoopOfBatch"][];
      clusters: components["schemas"]["LoopCluster"][];
      cascades: components["schemas"]["LoopCascade"][];
      ranking: components["schemas"]["LoopRank"][];
      changes?: {
        loop: number;
        tag: string;
        change: components["schemas"]["LoopChange"];
      }[];
      only_now?: string[];
      only_before?: string[];
      failed: number;
      complete: boolean;
    };
    LoopOfBatch: {
      tag: string;
      quality: components["schemas"]["CheckedRecord"];
      service: components["schemas"]["LoopService"];
      oscillation: components["schemas"]["LoopOscillation"];
      cause: components["schemas"]["LoopCause"];
      performance: components["schemas"]["LoopPerformance"];
      action: components["schemas"]["CheckAction"];
      cure?: components["schemas"]["LoopCure"];
      weight?: number;
      trend: components["schemas"]["LoopTrend"];
      index: number;
      job: string;
      units?: components["schemas"]["Units"];
    };
    LoopChange: {
      before: "healthy" | "stiction" | "backlash" | "tight" | "sluggish" | "external" | "saturation" | "quantised" | "manual" | "frozen" | "undetermined" | "insufficient-data";
      now: "healthy" | "stiction" | "backlash" | "tight" | "sluggish" | "external" | "saturation" | "quantised" | "manual" | "frozen" | "undetermined" | "insufficient-data";
      variability_ratio: number | null;
      likelihood: number | null;
      significant: boolean;
      why_null?: {
        [key: string]: string;
      };
    };
    RangeRequest: {
      name?: string;
      units?: components["schemas"]["Units"];
      scheduling?: components["schemas"]["Scheduling"];
      points?: components["schemas"]["GivenRangePoint"][];
      plant?: components["schemas"]["PlantModel"] | components["schemas"]["TypedPlant"];
      range?: components["schemas"]["RangeOfEquations"];
      identify?: components["schemas"]["Identify"];
      uncertainty?: "none" | "identified";
      schedule?: components["schemas"]["ScheduleWish"];
      runs?: boolean;
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
    };
    Scheduling: {
      name?: string;
      unit?: string;
    };
    GivenRangePoint: {
      at: number;
      plant?: components["schemas"]["PlantModel"] | components["schemas"]["TypedPlant"];
      record?: components["schemas"]["Record"];
    };
    RangeOfEquations: {
      along?: "output" | "input" | "parameter";
      parameter?: string;
      from: number;
      to: number;
      hold_output?: boolean;
    };
    ScheduleWish: {
      controller?: "PID" | "PI";
      Ms?: number;
      Mt?: number;
      filter?: components["schemas"]["RangeFilter"];
      aim?: "worst" | "mean";
      allowance?: number;
      rows?: number;
      interpolation?: "steps" | "linear_in_gains" | "linear_in_times";
      hysteresis?: number;
      between?: "parameters" | "frequency_response";
      b?: number;
      given?: components["schemas"]["GivenRow"][];
    };
    RangeFilter: {
      Tf?: number;
      Tf_over_Td?: number;
    };
    GivenRow: {
      at: number;
      Kp: number;
      Ti: number;
      Td?: number;
      Tf?: number;
      b?: number;
    };
    RangeResult: {
      units?: components["schemas"]["Units"];
      range: components["schemas"]["Range"];
      compute_ms: number;
      partial: boolean;
      version: string;
      request_hash: string;
    };
    Range: {
      scheduling: {
        name: string;
        unit?: string;
        from: number;
        to: number;
      };
      stated: string;
      points: components["schemas"]["RangePoint"][];
      one: components["schemas"]["OneSetting"] | null;
      schedule: components["schemas"]["Schedule"] | null;
      curves: components["schemas"]["RangeCurves"];
      worst: components["schemas"]["RangeWorst"];
      verdict?: components["schemas"]["Finding"];
      runs?: components["schemas"]["RangePassage"][];
      warnings: components["schemas"]["Warning"][];
      why_null?: {
        [key: string]: string;
      };
    };
    RangePoint: {
      at: number;
      plant: components["schemas"]["Plant"];
      model?: components["schemas"]["Model"];
      u?: number;
      y?: number;
    };
    OneSetting: {
      controller: components["schemas"]["Controller"];
      worst_relative_IAE: number;
      mean_relative_IAE: number;
      worst_at: number;
      points: components["schemas"]["PointCost"][];
    };
    PointCost: {
      at: number;
      own: components["schemas"]["Controller"];
      own_IAE: number;
      IAE: number | null;
      relative_IAE: number | null;
      Ms: number | null;
      Mt: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    Schedule: {
      interpolation: "steps" | "linear_in_gains" | "linear_in_times";
      hysteresis: number;
      rows: components["schemas"]["ScheduleRow"][];
      holds_limits: boolean;
      within_allowance: boolean;
      worst_relative_IAE: number | null;
      longest_sample_time: number | null;
    };
    ScheduleRow: {
      at: number;
      Kp: number;
      Ti: number;
      Td: number;
      Tf: number;
      b: number;
    };
    RangeCurves: {
      at: number[];
      K: (number | null)[];
      T: (number | null)[];
      L: (number | null)[];
      u?: (number | null)[];
      y?: (number | null)[];
      one?: components["schemas"]["RangeTraces"];
      schedule?: components["schemas"]["RangeTraces"];
    };
    RangeTraces: {
      Ms: (number | null)[];
      Mt: (number | null)[];
      relative_IAE: (number | null)[];
      Kp?: (number | null)[];
      Ti?: (number | null)[];
      Td?: (number | null)[];
    };
    RangeWorst: {
      one?: components["schemas"]["WorstPlace"][];
      schedule?: components["schemas"]["WorstPlace"][];
    };
    WorstPlace: {
      quantity: "Ms" | "Mt" | "relative_IAE";
      at: number;
      value: number | null;
      limit: number;
      why_null?: {
        [key: string]: string;
      };
    };
    RangePassage: {
      name: string;
      horizon: number;
      t: number[];
      target: (number | null)[];
      one?: components["schemas"]["RangeRun"];
      schedule?: components["schemas"]["RangeRun"];
      nonlinear: components["schemas"]["RangeNonlinearRun"] | null;
      why_null?: {
        [key: string]: string;
      };
    };
    RangeRun: {
      y: (number | null)[];
      u: (number | null)[];
      at: (number | null)[];
      Kp: (number | null)[];
      IAE: number;
      largest_error: number;
      largest_bump: number;
      switches: number;
      limited: boolean;
      settled: boolean;
      ended?: string;
      warnings: components["schemas"]["Warning"][];
    };
    RangeNonlinearRun: {
      y: (number | null)[];
      u: (number | null)[];
      tau: number;
      IAE: number;
      limited: boolean;
      settled: boolean;
      ended?: string;
    };
    CascadeRequest: {
      structure?: "cascade";
      name?: string;
      units?: components["schemas"]["Units"];
      evaluate?: components["schemas"]["StructureEvaluate"];
      implement?: components["schemas"]["Implement"] | components["schemas"]["Implement"][];
      sampled?: components["schemas"]["StructureSampled"];
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
      inner?: components["schemas"]["CascadeLoop"];
      outer?: components["schemas"]["CascadeLoop"];
      record?: components["schemas"]["Record"];
      arrangement?: "series" | "parallel";
      limits?: components["schemas"]["CascadeLimits"];
      search?: "sequential" | "joint";
      weights?: components["schemas"]["CascadeWeights"];
      baseline?: components["schemas"]["CascadePair"];
      compare_single?: boolean;
    };
    StructureEvaluate: {
      points?: number;
    };
    StructureSampled: {
      sample_time?: number;
      integral?: "backward" | "forward" | "trapezoidal";
      derivative?: "difference" | "filtered_backward" | "filtered_forward" | "filtered_trapezoidal" | "slope" | "four_points";
      slope_samples?: number;
      form?: "position" | "velocity";
      anti_windup?: "back_calculation" | "clamping";
      tracking_time?: number;
      u_min?: number;
      u_max?: number;
      rate_limit?: number;
      bias?: number;
      y0?: number;
      r2_min?: number;
      r2_max?: number;
      r2_bias?: number;
      d0?: number;
      compensator?: "static" | "inverse" | "guzman_hagglund" | "optimum" | "given";
      steps?: {
        [key: string]: number | null;
      };
    };
    CascadeLoop: {
      plant?: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      record?: components["schemas"]["Record"];
      tune?: components["schemas"]["LoopDesign"];
      controller?: components["schemas"]["Controller"];
    };
    LoopDesign: {
      method?: "robust";
      controller?: "PI" | "PID";
      Ms?: number;
      Mt?: number;
    };
    CascadeLimits: {
      Ms_valve?: number;
    };
    CascadeWeights: {
      d1?: number;
      d2?: number;
    };
    CascadePair: {
      inner: components["schemas"]["Controller"];
      outer: components["schemas"]["Controller"];
    };
    CascadeAnswer: {
      structure: "cascade";
      inner: {
        controller: components["schemas"]["Controller"];
        robustness: {
          Ms: number | null;
          Mt: number | null;
          why_null?: {
            [key: string]: string;
          };
        };
      };
      outer: {
        controller: components["schemas"]["Controller"];
        robustness: {
          Ms: number | null;
          Mt: number | null;
          Ms_valve: number | null;
          gain_margin: number | null;
          phase_margin_deg: number | null;
          dead_time_up: number | null;
          why_null?: {
            [key: string]: string;
          };
        };
      };
      Ms_valve_limit: number;
      performance: {
        inner_load: components["schemas"]["StructureStep"];
        outer_load: components["schemas"]["StructureStep"];
        setpoint: components["schemas"]["StructureStep"];
      };
      speed_ratio: number | null;
      single: components["schemas"]["SingleLoop"] | null;
      gain: {
        inner_load: number | null;
        outer_load: number | null;
        setpoint: number | null;
        why_null?: {
          [key: string]: string;
        };
      };
      baseline?: components["schemas"]["CascadeBaseline"];
      partial?: boolean;
      verdict: components["schemas"]["Conclusion"][];
      identified?: components["schemas"]["StructureModel"][];
      sampled?: components["schemas"]["StructureSampledAnswer"];
      settings?: components["schemas"]["StructureTyping"][];
      responses: {
        of: string;
        input: string;
        t: number[];
        signals: {
          name: string;
          values: number[];
        }[];
      }[];
      sensitivities: {
        omega: number[];
        curves: {
          of: string;
          loop: string;
          values: number[];
          limit?: number;
        }[];
      };
      version: string;
      units?: components["schemas"]["Units"];
      request_hash?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    StructureStep: {
      IAE: number | null;
      IE: number | null;
      peak: number | null;
      TV: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    SingleLoop: {
      controller: components["schemas"]["Controller"];
      Ms: number | null;
      Mt: number | null;
      performance: {
        inner_load: components["schemas"]["StructureStep"];
        outer_load: components["schemas"]["StructureStep"];
        setpoint: components["schemas"]["StructureStep"];
      };
      why_null?: {
        [key: string]: string;
      };
    };
    CascadeBaseline: {
      stable: boolean;
      robustness: {
        Ms_inner: number | null;
        Ms_outer: number | null;
        Ms_valve: number | null;
        why_null?: {
          [key: string]: string;
        };
      };
      performance: {
        inner_load: components["schemas"]["StructureStep"];
        outer_load: components["schemas"]["StructureStep"];
        setpoint: components["schemas"]["StructureStep"];
      };
    };
    Conclusion: {
      code: "unstable" | "cascade-pays" | "cascade-gains-little" | "inner-too-slow" | "inner-peak-above" | "outer-peak-above" | "valve-peak-above" | "near-lowest-rate" | "level-above-room" | "flow-loop-unstable" | "flow-loop-too-slow" | "feedforward-exact" | "feedforward-pays" | "feedforward-gains-little" | "feedforward-worse-than-none" | "gain-alone-worse-than-none" | "peak-unavoidable" | "wrong-model-worse-than-none" | "pid-does-as-well" | "predictor-pays" | "limited-by-dead-time-error" | "narrow-dead-time-window" | "controller-unstable" | "pairing-impossible" | "other-pairing-better" | "hardly-interacting" | "mu-above" | "subsets-unstable" | "better-than-blt" | "decoupler-helps" | "decoupler-worse-than-none" | "decoupler-fragile";
      figures: {
        why_null?: {
          [key: string]: string;
        };
      } & {
        [key: string]: number | null;
      };
    };
    StructureModel: {
      name: string;
      model: components["schemas"]["Model"];
    };
    StructureSampledAnswer: {
      sample_time: number;
      Ms: {
        why_null?: {
          [key: string]: string;
        };
      } & {
        [key: string]: number | null;
      };
      responses: {
        input: string;
        figures: components["schemas"]["StructureStep"][];
        largest_rate: number;
        t: number[];
        signals: {
          name: string;
          values: number[];
        }[];
      }[];
    };
    StructureTyping: {
      loop: string;
      typing: components["schemas"]["SettingsAnswer"] | null;
      why?: string;
    };
    LevelRequest: {
      structure?: "level";
      name?: string;
      units?: components["schemas"]["Units"];
      evaluate?: components["schemas"]["StructureEvaluate"];
      implement?: components["schemas"]["Implement"] | components["schemas"]["Implement"][];
      sampled?: components["schemas"]["StructureSampled"];
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
      volume: number;
      largest_step: number;
      allowed: number;
      aim?: "rate" | "no_outflow_overshoot" | "zeta";
      zeta?: number;
      gap?: number;
      flow_loop?: components["schemas"]["FlowLoop"];
      controller?: components["schemas"]["LevelSettings"];
    };
    FlowLoop: {
      T?: number;
      L?: number;
    };
    LevelSettings: {
      Kc: number;
      Ti?: number;
    };
    ScoreRequest: {
      name?: string;
      tune?: components["schemas"]["Method"];
      settings?: components["schemas"]["SubmittedSettings"][];
      problems?: components["schemas"]["ProblemChoice"];
    };
    SubmittedSettings: {
      problem: string;
      Kp: number;
      Ti: number;
      Td?: number;
    };
    ProblemChoice: {
      name?: string;
      structure?: "pi" | "pid_tied" | "pid_fixed";
      Ms?: number;
    };
    ScoreAnswer: {
      name: string;
      kept: number;
      limits_broken: number;
      unstable: number;
      no_settings: number;
      median_ratio?: number;
      worst_ratio?: number;
      range?: components["schemas"]["ScoreRange"];
      profile: components["schemas"]["ProfilePoint"][];
      problems: components["schemas"]["ProblemScore"][];
    };
    ScoreRange: {
      tau_low: number;
      tau_high: number;
      problems: number;
      worst_ratio: number;
    };
    ProfilePoint: {
      ratio: number;
      share: number;
    };
    ProblemScore: {
      name: string;
      status: "kept" | "limits-broken" | "unstable" | "no-settings";
      tau: number;
      controller?: components["schemas"]["Controller"];
      Ms?: number;
      Mt?: number;
      IAE?: number;
      ratio?: number;
      why?: string;
    };
    LevelAnswer: {
      structure: "level";
      design: components["schemas"]["LevelDesign"];
      gap?: number;
      bound: number;
      robustness: {
        Ms: number | null;
        highest: number | null;
        largest_rate: number | null;
        why_null?: {
          [key: string]: string;
        };
      };
      frontier: components["schemas"]["LevelDesign"][];
      partial?: boolean;
      verdict: components["schemas"]["Conclusion"][];
      identified?: components["schemas"]["StructureModel"][];
      sampled?: components["schemas"]["StructureSampledAnswer"];
      settings?: components["schemas"]["StructureTyping"][];
      responses: {
        of: string;
        input: string;
        t: number[];
        signals: {
          name: string;
          values: number[];
        }[];
      }[];
      sensitivities: {
        omega: number[];
        curves: {
          of: string;
          loop: string;
          values: number[];
          limit?: number;
        }[];
      };
      version: string;
      units?: components["schemas"]["Units"];
      request_hash?: string;
    };
    LevelDesign: {
      Kc: number | null;
      Ti: number | null;
      zeta: number | null;
      highest: number | null;
      time_of_highest: number | null;
      largest_rate: number | null;
      rate_over_bound: number | null;
      overshoot_percent: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    FeedforwardRequest: {
      structure?: "feedforward";
      name?: string;
      units?: components["schemas"]["Units"];
      evaluate?: components["schemas"]["StructureEvaluate"];
      implement?: components["schemas"]["Implement"] | components["schemas"]["Implement"][];
      sampled?: components["schemas"]["StructureSampled"];
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
      plant?: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      disturbance?: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      record?: components["schemas"]["Record"];
      feedback: components["schemas"]["Controller"] | {
        tune: components["schemas"]["LoopDesign"];
      };
      feedforward?: components["schemas"]["FeedforwardWish"];
      controller?: components["schemas"]["Feedforward"];
      uncertainty?: number;
    };
    FeedforwardWish: {
      jump?: number;
      method?: "static" | "inverse" | "guzman_hagglund" | "optimum";
      form?: "lead_lag";
    };
    Feedforward: {
      Kf: number;
      Tz: number;
      Tp: number;
      Lf: number;
    };
    FeedforwardAnswer: {
      structure: "feedforward";
      feedback: components["schemas"]["Controller"];
      variants: components["schemas"]["FeedforwardVariant"][];
      chosen: string;
      late: number;
      peak_bound: number;
      partial?: boolean;
      verdict: components["schemas"]["Conclusion"][];
      identified?: components["schemas"]["StructureModel"][];
      sampled?: components["schemas"]["StructureSampledAnswer"];
      settings?: components["schemas"]["StructureTyping"][];
      responses: {
        of: string;
        input: string;
        t: number[];
        signals: {
          name: string;
          values: number[];
        }[];
      }[];
      sensitivities: {
        omega: number[];
        curves: {
          of: string;
          loop: string;
          values: number[];
          limit?: number;
        }[];
      };
      version: string;
      units?: components["schemas"]["Units"];
      request_hash?: string;
    };
    FeedforwardVariant: {
      kind: "none" | "static" | "inverse" | "guzman_hagglund" | "optimum" | "given";
      compensator: components["schemas"]["Feedforward"] | null;
      IAE: number | null;
      IE: number | null;
      peak: number | null;
      TV: number | null;
      u_start: number;
      IAE_if_wrong?: {
        disturbance_gain_low: number | null;
        disturbance_gain_high: number | null;
        plant_dead_time_short: number | null;
        plant_dead_time_long: number | null;
        why_null?: {
          [key: string]: string;
        };
      };
      why_not?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    InteractionRequest: {
      structure?: "interaction";
      name?: string;
      units?: components["schemas"]["Units"];
      evaluate?: components["schemas"]["StructureEvaluate"];
      implement?: components["schemas"]["Implement"] | components["schemas"]["Implement"][];
      sampled?: components["schemas"]["StructureSampled"];
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
      plant?: (components["schemas"]["Plant"] | components["schemas"]["TypedPlant"] | null | 0)[][];
      records?: components["schemas"]["Record"][];
      pairing?: number[] | null;
      controllers?: ("PI" | "PID") | components["schemas"]["Controller"][];
      limit?: components["schemas"]["InteractionLimit"];
      weights?: components["schemas"]["InteractionWeights"];
      baseline?: components["schemas"]["Controller"][];
      decoupler?: "none" | "static" | "simplified";
      compare?: ("blt" | "detuned" | "static_decoupler" | "simplified_decoupler")[];
    };
    InteractionLimit: {
      mu?: number;
    };
    InteractionWeights: {
      y?: number[];
    };
    InteractionAnswer: {
      structure: "interaction";
      rga: (number | null)[][];
      condition: number;
      pairings: components["schemas"]["Pairing"][];
      pairing: number[];
      controllers: components["schemas"]["Controller"][];
      stable: boolean;
      Ms_alone: (number | null)[];
      Ms_others_closed: (number | null)[];
      mu: number | null;
      omega_mu: number | null;
      Lcm_dB: number | null;
      IAE_load: (number | null)[][];
      IAE_setpoint: (number | null)[][];
      cost: number | null;
      decoupling?: components["schemas"]["Decoupling"];
      manual: {
        may_open: boolean[];
        unstable_in_automatic: number[][];
      };
      F_blt: number | null;
      compared: components["schemas"]["ComparedControllers"][];
      partial?: boolean;
      verdict: components["schemas"]["Conclusion"][];
      identified?: components["schemas"]["StructureModel"][];
      sampled?: components["schemas"]["StructureSampledAnswer"];
      settings?: components["schemas"]["StructureTyping"][];
      responses: {
        of: string;
        input: string;
        t: number[];
        signals: {
          name: string;
          values: number[];
        }[];
      }[];
      sensitivities: {
        omega: number[];
        curves: {
          of: string;
          loop: string;
          values: number[];
          limit?: number;
        }[];
      };
      version: string;
      units?: components["schemas"]["Units"];
      request_hash?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    Pairing: {
      inputs: number[];
      niederlinski: number | null;
      relative_gains: (number | null)[];
      relative_gains_at_crossover: (number | null)[];
      possible: boolean;
      why_null?: {
        [key: string]: string;
      };
    };
    Decoupling: {
      kind: string;
      D: (components["schemas"]["DecouplerElement"] | null)[][];
      unrealised: number[][];
      gain: number | null;
      wrong_gains: components["schemas"]["WrongGains"];
      why_null?: {
        [key: string]: string;
      };
    };
    DecouplerElement: {
      Kf: number;
      Tz: number;
      Tp: number;
      Lf: number;
    };
    WrongGains: {
      by: number;
      stable: boolean;
      mu: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    ComparedControllers: {
      name: string;
      controllers: components["schemas"]["Controller"][];
      stable: boolean;
      Ms_alone: (number | null)[];
      Ms_others_closed: (number | null)[];
      mu: number | null;
      omega_mu: number | null;
      Lcm_dB: number | null;
      IAE_load: (number | null)[][];
      IAE_setpoint: (number | null)[][];
      cost: number | null;
      decoupling?: components["schemas"]["Decoupling"];
      why_not?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    PredictorRequest: {
      structure?: "predictor";
      name?: string;
      units?: components["schemas"]["Units"];
      evaluate?: components["schemas"]["StructureEvaluate"];
      implement?: components["schemas"]["Implement"] | components["schemas"]["Implement"][];
      sampled?: components["schemas"]["StructureSampled"];
      timeout_s?: number;
      priority?: "normal" | "low";
      not_before?: string;
      unique?: boolean;
      notify?: components["schemas"]["Notify"];
      plant: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      model?: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      kind?: "smith" | "filtered_smith" | "predictive_pi";
      Ms?: number;
      dead_time_error?: number;
      controller?: components["schemas"]["PredictorController"];
    };
    PredictorController: {
      C: components["schemas"]["Rational"];
      F: components["schemas"]["Rational"];
    };
    Rational: {
      num: number[];
      den: number[];
    };
    PredictorAnswer: {
      structure: "predictor";
      controller: components["schemas"]["PredictorController"];
      model: {
        K: number;
        T?: number;
        L: number;
      };
      lambda?: number;
      Tf?: number;
      beta?: number;
      robustness: components["schemas"]["PredictorRobustness"];
      load: components["schemas"]["StructureStep"];
      setpoint: components["schemas"]["StructureStep"];
      pid: components["schemas"]["Controller"] | null;
      pid_IAE: number | null;
      partial?: boolean;
      verdict: components["schemas"]["Conclusion"][];
      identified?: components["schemas"]["StructureModel"][];
      sampled?: components["schemas"]["StructureSampledAnswer"];
      settings?: components["schemas"]["StructureTyping"][];
      responses: {
        of: string;
        input: string;
        t: number[];
        signals: {
          name: string;
          values: number[];
        }[];
      }[];
      sensitivities: {
        omega: number[];
        curves: {
          of: string;
          loop: string;
          values: number[];
          limit?: number;
        }[];
      };
      version: string;
      units?: components["schemas"]["Units"];
      request_hash?: string;
      why_null?: {
        [key: string]: string;
      };
    };
    PredictorRobustness: {
      stable: boolean;
      controller_stable: boolean;
      Ms: number | null;
      Mt: number | null;
      dead_time_up: number | null;
      dead_time_down: number | null;
      why_null?: {
        [key: string]: string;
      };
    };
    EvaluateAnswer: {
      operating_point?: components["schemas"]["OperatingPoint"];
      linear_model?: components["schemas"]["Plant"];
      controllers: components["schemas"]["Entry"][];
      verdict: components["schemas"]["Finding"][];
      rank_limits?: {
        Ms: number;
      };
      proposed?: number;
    };
    IdentifyRequest: {
      name?: string;
      units?: components["schemas"]["Units"];
      record: components["schemas"]["Record"];
      identify?: components["schemas"]["Identify"];
    };
    IdentifyAnswer: {
      model: components["schemas"]["Model"];
    };
    ControllerRecordAnswer: {
      identified?: components["schemas"]["IdentifiedController"];
      not_identified?: string;
      typing?: components["schemas"]["SettingsAnswer"];
      not_typed?: string;
    };
    IdentifiedController: {
      controller: components["schemas"]["Controller"];
      standard_errors: {
        [key: string]: number | null;
      };
      certain: boolean;
      sample_time?: number;
      delay: number;
      b_known: boolean;
      explained: number;
      rows: number;
      manual_rows: number;
      limited_rows: number;
      odd_rows: number;
      warnings: components["schemas"]["Warning"][];
    };
    PlantQuestion: {
      units?: components["schemas"]["Units"];
      text?: components["schemas"]["TypedPlant"];
      plant?: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      unfinished?: boolean;
    };
    PlantAnswer: {
      plant?: components["schemas"]["Plant"];
      formula?: string;
      text?: string;
      snippets?: components["schemas"]["Snippet"][];
      fault?: string;
    };
    PreviewAnswer: {
      columns: components["schemas"]["PreviewColumn"][];
      rows: number;
      separator: string;
      decimal: string;
      encoding: string;
      time?: components["schemas"]["PreviewTime"];
      runs: components["schemas"]["PreviewRun"][];
      run?: number;
      skipped: components["schemas"]["SkippedLine"][];
      skipped_lines: number;
      notes: string[];
      problems: components["schemas"]["ReadingProblem"][];
    };
    PreviewColumn: {
      heading: string;
      guess: string;
      confidence: number;
      unit: string;
      first: string;
      min?: number;
      max?: number;
      thumbnail: (number | null)[];
    };
    PreviewTime: {
      unit: string;
      assumed: boolean;
      from: number;
      to: number;
      dt: number;
      gaps: number;
      duplicates: number;
    };
    PreviewRun: {
      first_line: number;
      last_line: number;
      rows: number;
      from: number;
      to: number;
      tests: boolean;
    };
    SkippedLine: {
      line: number;
      reason: string;
    };
    ReadingProblem: {
      pointer: string;
      detail: string;
    };
    RelayRequest: {
      name?: string;
      units?: components["schemas"]["Units"];
      plant: components["schemas"]["Plant"] | components["schemas"]["TypedPlant"];
      relay?: components["schemas"]["Relay"];
    };
    Relay: {
      u_plus?: number;
      u_minus?: number;
      hysteresis?: number;
      noise_std?: number;
      relay_sample_time?: number;
      record_interval?: number;
      cycles?: number;
      seed?: number;
      shift?: number;
    };
    ExperimentCodeRequest: {
      experiment: "relay" | "bump";
      language: "st" | "c" | "python" | "arduino";
      sample_time: number;
      u_step: number;
      asymmetry?: number;
      cycles?: number;
      action?: "find" | "reverse" | "direct";
      y_move?: number;
      hysteresis?: number;
      u_min?: number;
      u_max?: number;
      y_min?: number;
      y_max?: number;
      u_safe?: number;
      rate_limit?: number;
      quiet_time?: number;
      max_time?: number;
      frozen_time?: number;
    };
    RelayAnswer: {
      record: components["schemas"]["RelayRecord"];
      limit_cycle: components["schemas"]["LimitCycle"];
      reversed: boolean;
      plan: components["schemas"]["RelayPlan"];
      warnings: components["schemas"]["Warning"][];
    };
    RelayRecord: {
      kind: "relay";
      t: number[];
      u: number[];
      y: number[];
      u0: 0;
      y0: 0;
    };
    RelayPlan: {
      u_plus: number;
      u_minus: number;
      hysteresis: number;
      amplitude: number;
      expected_period: number;
      cycles: number;
      duration: number;
      record_interval: number;
      reason: string;
    };
    ControllerSummary: {
      id: string;
      maker: string;
      name: string;
      families: string[];
      form: string;
      needs: string[];
      evidence: string;
      parameters: string[];
    };
    ControllerProduct: {
      id: string;
      maker: string;
      name: string;
      families: string[];
      form: string;
      needs: string[];
      law: string;
      gain_basis: string;
      parameters: components["schemas"]["ControllerParameter"][];
      filter?: string;
      setpoint_weights: components["schemas"]["ControllerWeights"];
      action: components["schemas"]["ControllerAction"];
      algorithm: components["schemas"]["ControllerAlgorithm"];
      gain_scheduling?: components["schemas"]["GainScheduling"];
      traps: string[];
      evidence: components["schemas"]["ControllerEvidence"];
      example: components["schemas"]["ControllerExample"];
    };
    ControllerParameter: {
      name: string;
      label: string;
      unit: string;
      role: string;
      formula: string;
      low: number | null;
      high: number | null;
      resolution: number | null;
      off: number | null;
      written: boolean;
      remark?: string;
      default?: number | string | boolean;
      choices?: {
        value: number | string | boolean;
        b?: number;
        c?: number;
      }[];
    };
    ControllerWeights: {
      b: number | null;
      c: number | null;
      text?: string;
    };
    ControllerAction: {
      by: string;
      name?: string;
      text?: string;
      direct?: number | string | boolean;
    };
    ControllerAlgorithm: {
      integral: string;
      derivative: string;
      form: string;
      published: boolean;
      sample_time: number | null;
      clock_fixed: boolean;
      sample_time_text?: string;
      anti_windup?: string;
      text?: string;
    };
    GainScheduling: {
      sets: number | null;
      interpolation?: "steps" | "linear_in_gains" | "linear_in_times";
      detail: string;
      source: string;
    };
    ControllerEvidence: {
      level: string;
      read: string[];
      unverified: string[];
      sources: string[];
    };
    ControllerExample: {
      sample_time: number | null;
      controller: components["schemas"]["Controller"];
      y_span: number[];
      u_span: number[];
      settings: {
        [key: string]: number | string | boolean;
      };
    };
    ScheduleSettingsAnswer: {
      rows: components["schemas"]["SettingsRow"][];
      notes: components["schemas"]["SettingsNote"][];
    };
    SettingsRow: {
      at: number;
      typing: components["schemas"]["SettingsAnswer"];
    };
  };
  responses: never;
  parameters: never;
  requestBodies: never;
  headers: never;
  pathItems: never;
};
export type Problem = components['schemas']['Problem'];
export type Fault = components['schemas']['Fault'];
export type JobStatus = components['schemas']['JobStatus'];
export type Progress = components['schemas']['Progress'];
export type JobSummary = components['schemas']['JobSummary'];
export type JobOutline = components['schemas']['JobOutline'];
export type Job = components['schemas']['Job'];
export type JobList = components['schemas']['JobList'];
export type Batch = components['schemas']['Batch'];
export type MethodDescription = components['schemas']['MethodDescription'];
export type Example = components['schemas']['Example'];
export type RangeExample = components['schemas']['RangeExample'];
export type Health = components['schemas']['Health'];
export type TuningRequest = components['schemas']['TuningRequest'];
export type Units = components['schemas']['Units'];
export type PlantModel = components['schemas']['PlantModel'];
export type Plant = components['schemas']['Plant'];
export type TypedPlant = components['schemas']['TypedPlant'];
export type Record = components['schemas']['Record'];
export type MeasuredDisturbance = components['schemas']['MeasuredDisturbance'];
export type Columns = components['schemas']['Columns'];
export type UltimateTest = components['schemas']['UltimateTest'];
export type Identify = components['schemas']['Identify'];
export type Method = components['schemas']['Method'];
export type Controller = components['schemas']['Controller'];
export type SetpointFilter = components['schemas']['SetpointFilter'];
export type Filter = components['schemas']['Filter'];
export type ParallelController = components['schemas']['ParallelController'];
export type SeriesController = components['schemas']['SeriesController'];
export type TypedSettings = components['schemas']['TypedSettings'];
export type TypedController = components['schemas']['TypedController'];
export type Implement = components['schemas']['Implement'];
export type Evaluate = components['schemas']['Evaluate'];
export type Actuator = components['schemas']['Actuator'];
export type Noise = components['schemas']['Noise'];
export type OwnStep = components['schemas']['OwnStep'];
export type OwnLoad = components['schemas']['OwnLoad'];
export type Notify = components['schemas']['Notify'];
export type TuningResult = components['schemas']['TuningResult'];
export type Model = components['schemas']['Model'];
export type Covariance = components['schemas']['Covariance'];
export type Disturbance = components['schemas']['Disturbance'];
export type LimitCycle = components['schemas']['LimitCycle'];
export type ShiftedPoint = components['schemas']['ShiftedPoint'];
export type UltimatePoint = components['schemas']['UltimatePoint'];
export type FrequencyPoint = components['schemas']['FrequencyPoint'];
export type ExcitedBand = components['schemas']['ExcitedBand'];
export type Region = components['schemas']['Region'];
export type Candidate = components['schemas']['Candidate'];
export type Fit = components['schemas']['Fit'];
export type DataQuality = components['schemas']['DataQuality'];
export type PreTest = components['schemas']['PreTest'];
export type MissingPart = components['schemas']['MissingPart'];
export type Saturation = components['schemas']['Saturation'];
export type Outliers = components['schemas']['Outliers'];
export type ClosedLoop = components['schemas']['ClosedLoop'];
export type Warning = components['schemas']['Warning'];
export type ReplayedRecord = components['schemas']['ReplayedRecord'];
export type ReplayFigures = components['schemas']['ReplayFigures'];
export type OperatingPoint = components['schemas']['OperatingPoint'];
export type Entry = components['schemas']['Entry'];
export type Finding = components['schemas']['Finding'];
export type Equivalents = components['schemas']['Equivalents'];
export type Robustness = components['schemas']['Robustness'];
export type Nonlinear = components['schemas']['Nonlinear'];
export type Performance = components['schemas']['Performance'];
export type SetpointPerformance = components['schemas']['SetpointPerformance'];
export type LoadPerformance = components['schemas']['LoadPerformance'];
export type NoisePerformance = components['schemas']['NoisePerformance'];
export type Responses = components['schemas']['Responses'];
export type Trace = components['schemas']['Trace'];
export type StepResponse = components['schemas']['StepResponse'];
export type Frequency = components['schemas']['Frequency'];
export type Verification = components['schemas']['Verification'];
export type IndexErrors = components['schemas']['IndexErrors'];
export type SettingsAnswer = components['schemas']['SettingsAnswer'];
export type Snippet = components['schemas']['Snippet'];
export type SettingsNote = components['schemas']['SettingsNote'];
export type Implemented = components['schemas']['Implemented'];
export type Difference = components['schemas']['Difference'];
export type CostSurface = components['schemas']['CostSurface'];
export type Certificate = components['schemas']['Certificate'];
export type Frontier = components['schemas']['Frontier'];
export type FrontierPoint = components['schemas']['FrontierPoint'];
export type Rimc = components['schemas']['Rimc'];
export type FullController = components['schemas']['FullController'];
export type DisturbancePeakCurve = components['schemas']['DisturbancePeakCurve'];
export type OptimumAtMs = components['schemas']['OptimumAtMs'];
export type ReplayedEntry = components['schemas']['ReplayedEntry'];
export type OwnStepEntry = components['schemas']['OwnStepEntry'];
export type OwnSetpointFigures = components['schemas']['OwnSetpointFigures'];
export type OwnLoadFigures = components['schemas']['OwnLoadFigures'];
export type OwnStepTrace = components['schemas']['OwnStepTrace'];
export type Standing = components['schemas']['Standing'];
export type Tradeoff = components['schemas']['Tradeoff'];
export type TradeoffFigures = components['schemas']['TradeoffFigures'];
export type TradeoffProfile = components['schemas']['TradeoffProfile'];
export type TradeoffAtMs = components['schemas']['TradeoffAtMs'];
export type TradeoffAtLevel = components['schemas']['TradeoffAtLevel'];
export type Emulation = components['schemas']['Emulation'];
export type ActiveBound = components['schemas']['ActiveBound'];
export type EmulationFit = components['schemas']['EmulationFit'];
export type LevelOneRow = components['schemas']['LevelOneRow'];
export type EmulatedScenario = components['schemas']['EmulatedScenario'];
export type DesignAnswer = components['schemas']['DesignAnswer'];
export type CheckRequest = components['schemas']['CheckRequest'];
export type CheckLoop = components['schemas']['CheckLoop'];
export type LoopRanges = components['schemas']['LoopRanges'];
export type CheckResult = components['schemas']['CheckResult'];
export type LoopCheck = components['schemas']['LoopCheck'];
export type CheckedRecord = components['schemas']['CheckedRecord'];
export type LoopService = components['schemas']['LoopService'];
export type LoopOscillation = components['schemas']['LoopOscillation'];
export type LoopPeriod = components['schemas']['LoopPeriod'];
export type LoopCause = components['schemas']['LoopCause'];
export type CheckEvidence = components['schemas']['CheckEvidence'];
export type LoopPerformance = components['schemas']['LoopPerformance'];
export type HarrisRange = components['schemas']['HarrisRange'];
export type CheckAction = components['schemas']['CheckAction'];
export type LoopCure = components['schemas']['LoopCure'];
export type CheckTest = components['schemas']['CheckTest'];
export type CycleStops = components['schemas']['CycleStops'];
export type CycleStop = components['schemas']['CycleStop'];
export type LoopTrend = components['schemas']['LoopTrend'];
export type CheckCurve = components['schemas']['CheckCurve'];
export type LoopShape = components['schemas']['LoopShape'];
export type LoopCluster = components['schemas']['LoopCluster'];
export type LoopCascade = components['schemas']['LoopCascade'];
export type LoopRank = components['schemas']['LoopRank'];
export type BatchCheck = components['schemas']['BatchCheck'];
export type LoopOfBatch = components['schemas']['LoopOfBatch'];
export type LoopChange = components['schemas']['LoopChange'];
export type RangeRequest = components['schemas']['RangeRequest'];
export type Scheduling = components['schemas']['Scheduling'];
export type GivenRangePoint = components['schemas']['GivenRangePoint'];
export type RangeOfEquations = components['schemas']['RangeOfEquations'];
export type ScheduleWish = components['schemas']['ScheduleWish'];
export type RangeFilter = components['schemas']['RangeFilter'];
export type GivenRow = components['schemas']['GivenRow'];
export type RangeResult = components['schemas']['RangeResult'];
export type Range = components['schemas']['Range'];
export type RangePoint = components['schemas']['RangePoint'];
export type OneSetting = components['schemas']['OneSetting'];
export type PointCost = components['schemas']['PointCost'];
export type Schedule = components['schemas']['Schedule'];
export type ScheduleRow = components['schemas']['ScheduleRow'];
export type RangeCurves = components['schemas']['RangeCurves'];
export type RangeTraces = components['schemas']['RangeTraces'];
export type RangeWorst = components['schemas']['RangeWorst'];
export type WorstPlace = components['schemas']['WorstPlace'];
export type RangePassage = components['schemas']['RangePassage'];
export type RangeRun = components['schemas']['RangeRun'];
export type RangeNonlinearRun = components['schemas']['RangeNonlinearRun'];
export type CascadeRequest = components['schemas']['CascadeRequest'];
export type StructureEvaluate = components['schemas']['StructureEvaluate'];
export type StructureSampled = components['schemas']['StructureSampled'];
export type CascadeLoop = components['schemas']['CascadeLoop'];
export type LoopDesign = components['schemas']['LoopDesign'];
export type CascadeLimits = components['schemas']['CascadeLimits'];
export type CascadeWeights = components['schemas']['CascadeWeights'];
export type CascadePair = components['schemas']['CascadePair'];
export type CascadeAnswer = components['schemas']['CascadeAnswer'];
export type StructureStep = components['schemas']['StructureStep'];
export type SingleLoop = components['schemas']['SingleLoop'];
export type CascadeBaseline = components['schemas']['CascadeBaseline'];
export type Conclusion = components['schemas']['Conclusion'];
export type StructureModel = components['schemas']['StructureModel'];
export type StructureSampledAnswer = components['schemas']['StructureSampledAnswer'];
export type StructureTyping = components['schemas']['StructureTyping'];
export type LevelRequest = components['schemas']['LevelRequest'];
export type FlowLoop = components['schemas']['FlowLoop'];
export type LevelSettings = components['schemas']['LevelSettings'];
export type ScoreRequest = components['schemas']['ScoreRequest'];
export type SubmittedSettings = components['schemas']['SubmittedSettings'];
export type ProblemChoice = components['schemas']['ProblemChoice'];
export type ScoreAnswer = components['schemas']['ScoreAnswer'];
export type ScoreRange = components['schemas']['ScoreRange'];
export type ProfilePoint = components['schemas']['ProfilePoint'];
export type ProblemScore = components['schemas']['ProblemScore'];
export type LevelAnswer = components['schemas']['LevelAnswer'];
export type LevelDesign = components['schemas']['LevelDesign'];
export type FeedforwardRequest = components['schemas']['FeedforwardRequest'];
export type FeedforwardWish = components['schemas']['FeedforwardWish'];
export type Feedforward = components['schemas']['Feedforward'];
export type FeedforwardAnswer = components['schemas']['FeedforwardAnswer'];
export type FeedforwardVariant = components['schemas']['FeedforwardVariant'];
export type InteractionRequest = components['schemas']['InteractionRequest'];
export type InteractionLimit = components['schemas']['InteractionLimit'];
export type InteractionWeights = components['schemas']['InteractionWeights'];
export type InteractionAnswer = components['schemas']['InteractionAnswer'];
export type Pairing = components['schemas']['Pairing'];
export type Decoupling = components['schemas']['Decoupling'];
export type DecouplerElement = components['schemas']['DecouplerElement'];
export type WrongGains = components['schemas']['WrongGains'];
export type ComparedControllers = components['schemas']['ComparedControllers'];
export type PredictorRequest = components['schemas']['PredictorRequest'];
export type PredictorController = components['schemas']['PredictorController'];
export type Rational = components['schemas']['Rational'];
export type PredictorAnswer = components['schemas']['PredictorAnswer'];
export type PredictorRobustness = components['schemas']['PredictorRobustness'];
export type EvaluateAnswer = components['schemas']['EvaluateAnswer'];
export type IdentifyRequest = components['schemas']['IdentifyRequest'];
export type IdentifyAnswer = components['schemas']['IdentifyAnswer'];
export type ControllerRecordAnswer = components['schemas']['ControllerRecordAnswer'];
export type IdentifiedController = components['schemas']['IdentifiedController'];
export type PlantQuestion = components['schemas']['PlantQuestion'];
export type PlantAnswer = components['schemas']['PlantAnswer'];
export type PreviewAnswer = components['schemas']['PreviewAnswer'];
export type PreviewColumn = components['schemas']['PreviewColumn'];
export type PreviewTime = components['schemas']['PreviewTime'];
export type PreviewRun = components['schemas']['PreviewRun'];
export type SkippedLine = components['schemas']['SkippedLine'];
export type ReadingProblem = components['schemas']['ReadingProblem'];
export type RelayRequest = components['schemas']['RelayRequest'];
export type Relay = components['schemas']['Relay'];
export type ExperimentCodeRequest = components['schemas']['ExperimentCodeRequest'];
export type RelayAnswer = components['schemas']['RelayAnswer'];
export type RelayRecord = components['schemas']['RelayRecord'];
export type RelayPlan = components['schemas']['RelayPlan'];
export type ControllerSummary = components['schemas']['ControllerSummary'];
export type ControllerProduct = components['schemas']['ControllerProduct'];
export type ControllerParameter = components['schemas']['ControllerParameter'];
export type ControllerWeights = components['schemas']['ControllerWeights'];
export type ControllerAction = components['schemas']['ControllerAction'];
export type ControllerAlgorithm = components['schemas']['ControllerAlgorithm'];
export type GainScheduling = components['schemas']['GainScheduling'];
export type ControllerEvidence = components['schemas']['ControllerEvidence'];
export type ControllerExample = components['schemas']['ControllerExample'];
export type ScheduleSettingsAnswer = components['schemas']['ScheduleSettingsAnswer'];
export type SettingsRow = components['schemas']['SettingsRow'];
