//! `onetwo remote`: a request of a team's remote control to the league's game controller (TCP 10011), and the
//! team's state in its answer.

use std::net::SocketAddr;
use std::process::ExitCode;

use clap::Args;
use clap::builder::PossibleValuesParser;
use host::referee::remote::{RemoteControl, RemoteRequest, RemoteState};
use rules::Colour;
use ssl::net::addresses;

use crate::Failure;
use crate::args::parsers::{colour, remote_port};
use crate::output::{json_line, print_text};

/// The request, the team, and the controller.
#[derive(Debug, Args)]
pub(crate) struct RemoteArgs {
    /// What is asked for; status asks for nothing.
    #[arg(default_value = "status", value_parser = PossibleValuesParser::new(RemoteRequest::names()))]
    request: String,
    /// The shell number of the keeper, for `keeper`.
    #[arg(value_parser = clap::value_parser!(u8).range(0..=15))]
    robot: Option<u8>,
    /// Our team: blue or yellow.
    #[arg(long, value_name = "COLOUR", value_parser = colour)]
    colour: Colour,
    /// The game controller's port for remote controls.
    #[arg(long, value_name = "HOST[:PORT]", value_parser = remote_port, default_value_t = SocketAddr::from(([127, 0, 0, 1], addresses::REMOTE_PORT)))]
    controller: SocketAddr,
    /// Print the team's state as JSON, and nothing else.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &RemoteArgs) -> Result<ExitCode, Failure> {
    let request =
        RemoteRequest::named(&args.request, args.robot).map_err(|text| Failure::Other(text.into()))?;
    let mut control = RemoteControl::connect(args.controller, args.colour)?;
    let state = control.ask(request)?;
    print_text(&if args.json { json_line(&state)? } else { text(request, &state) })?;
    Ok(ExitCode::SUCCESS)
}

fn text(request: RemoteRequest, state: &RemoteState) -> String {
    let keeper = state.keeper.map_or_else(|| "none".to_owned(), |keeper| keeper.to_string());
    format!(
        "{:<9} granted\nactive    {}\navailable {}\nkeeper    {keeper}; {} of {} robots on the field\n\
         timeouts  {} left, {:.0} s; challenge flags {}; substitutions {}\n",
        request.name(),
        names(&state.active),
        names(&state.available),
        state.robots_on_field,
        state.max_robots,
        state.timeouts_left,
        state.timeout_left_s,
        state.challenge_flags_left,
        state.substitutions_left,
    )
}

fn names(requests: &[&str]) -> String {
    if requests.is_empty() { "none".to_owned() } else { requests.join(", ") }
}
