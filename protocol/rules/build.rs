//! Build script: the description of our robots, `robots/ours.toml` or what `ONETWO_ROBOT` names, checked, as
//! constants. A faulty description fails the build with its findings; doubts are warnings of the build.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::{env, fs};

use robots::{Description, VARIABLE};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed={VARIABLE}");
    let asked = env::var(VARIABLE).unwrap_or_default();
    let chosen = robots::chosen(&asked, &workspace()).unwrap_or_else(|error| panic!("{error}"));
    if let Some(file) = &chosen.file {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    let own = read(&chosen.source, &chosen.text);
    let (name, text) = robots::BUILT_IN[0];
    let reference = read(name, text);
    let code = format!(
        "pub(super) const OURS: RobotSpec = {};\npub(super) const REFERENCE: RobotSpec = {};\n\
         pub(super) const TEXT: &str = {:?};\npub(super) const SOURCE: &str = {:?};\n",
        spec(&own),
        spec(&reference),
        chosen.text,
        chosen.source
    );
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("robot.rs"), code).expect("the output directory is writable");
}

/// The directory that relative paths start at: the workspace's, two above this package.
fn workspace() -> PathBuf {
    let own = env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR");
    Path::new(&own).join("../..")
}

/// A description; a fault ends the build.
fn read(file: &str, text: &str) -> Description {
    let read = Description::read(file, text).unwrap_or_else(|findings| {
        for finding in &findings {
            println!("cargo::error={finding}");
        }
        panic!("the robot's description {file} is refused: see the findings");
    });
    for finding in read.warnings() {
        println!("cargo::warning={finding}");
    }
    read
}

/// The description as a value of `RobotSpec`.
fn spec(of: &Description) -> String {
    let n = |path: &str| format!("{:?}_f32", of.number(path));
    let whole = |path: &str| format!("{}", of.number(path));
    let drive =
        |table| format!("DriveSpec {{ {} }}", fields(&n, table, &["speed", "acceleration", "braking"]));
    let turn = |table| format!("TurnSpec {{ {} }}", fields(&n, table, &["rate", "acceleration"]));
    let slope = f64::from(of.number("kicker.chip_degrees")).to_radians().tan() as f32;
    let counts = 4.0 * of.number("wheels.encoder_lines") * of.number("wheels.encoder_gear");
    let wheels = robots::wheel_slots(&of.wheels());
    let fields = [
        format!("name: {:?}", of.name()),
        format!("hull: HullSpec {{ {} }}", fields(&n, "body", &["radius", "front", "opening"])),
        format!("plan: {}", drive("plan")),
        format!("plan_holding: {}", drive("plan_holding")),
        format!("turn: {}", turn("turn")),
        format!("turn_holding: {}", turn("turn_holding")),
        format!("turn_placing: {}", turn("turn_placing")),
        format!(
            "governor: GovernorSpec {{ {} }}",
            fields(&n, "governor", &["speed", "turn", "brake", "brake_turn"])
        ),
        format!(
            "assumed: AssumedSpec {{ pass: {}, turn: {}, role: TypicalSpec {{ {} }}, {} }}",
            drive("assumed.pass"),
            turn("assumed.turn"),
            fields(&n, "assumed.role", &["speed", "acceleration"]),
            fields(&n, "assumed", &["defence_acceleration", "blocker_acceleration", "kick_share"])
        ),
        format!(
            "kicker: KickerSpec {{ flat_pulses: &{:?}, chip_pulses: &{:?}, chip_slope: {slope:?}_f32, pause_ms: {}, {} }}",
            of.pulses("kicker.flat_pulses"),
            of.pulses("kicker.chip_pulses"),
            whole("kicker.pause_ms"),
            fields(&n, "kicker", &["fastest", "fastest_2013", "chip_degrees", "full_volts", "empty_volts"])
        ),
        format!("dribbler: DribblerSpec {{ {} }}", fields(&n, "dribbler", &["full_rpm"])),
        format!(
            "wheels: WheelSpec {{ count: {}, degrees: {:?}, levers: {:?}, distance: {:?}_f32, outputs: {:?}, \
             counts_a_turn: {counts:?}_f32, {}, {} }}",
            wheels.count,
            wheels.degrees,
            wheels.levers,
            wheels.distance,
            wheels.outputs,
            fields(&n, "wheels", &["radius", "free_speed", "rim_max"]),
            fields(&n, "motors", &["proportional", "integral"])
        ),
        format!("battery: BatterySpec {{ {} }}", fields(&n, "battery", &["low", "full"])),
        format!("break_beam: BreakBeamSpec {{ {} }}", fields(&n, "break_beam", &["hidden", "seen", "blind"])),
        format!("imu: ImuSpec {{ {} }}", fields(&n, "imu", &["unrest", "offset_max"])),
        format!(
            "parts: PartsSpec {{ motors: MotorScheme::{}, imu: ImuModel::{}, radio: RadioLine::{}, baud: {} }}",
            variant(of.text("motors.scheme")),
            variant(of.text("imu.model")),
            variant(of.text("radio.line")),
            whole("radio.baud")
        ),
        format!(
            "hardware: HardwareSpec {{ {}, {} }}",
            fields(&n, "body", &["height", "mouth", "mass"]),
            fields(
                &n,
                "hardware",
                &[
                    "speed",
                    "turn_speed",
                    "forward",
                    "side",
                    "brake",
                    "turn",
                    "rim_acceleration",
                    "flat",
                    "chip",
                    "recharge",
                    "pull"
                ]
            )
        ),
    ];
    format!("RobotSpec {{ {} }}", fields.join(",\n"))
}

/// `name: value` of some keys of a table.
fn fields(value: &impl Fn(&str) -> String, table: &str, names: &[&str]) -> String {
    let fields = names.iter().map(|name| format!("{name}: {}", value(&format!("{table}.{name}"))));
    fields.collect::<Vec<_>>().join(", ")
}

/// A word of the file as a variant: `pwm-direction` is `PwmDirection`.
fn variant(word: &str) -> String {
    let parts = word.split('-').map(|part| {
        let mut letters = part.chars();
        let first = letters.next().map(|letter| letter.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    });
    parts.collect()
}
