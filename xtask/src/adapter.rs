//! Making sure that something can draw: a GPU, or Mesa's software Vulkan.

use std::path::Path;
use std::process::Command;

use crate::process::{run, succeeds};
use crate::{Error, Result};

const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// Asks the built `genga` for an adapter. Where there is none, installs Mesa's software driver
/// if that needs no password, or else says which command does.
pub(crate) fn ensure(genga: &Path) -> Result<()> {
    if has_adapter(genga) {
        return Ok(());
    }
    println!("This machine has no graphics adapter that genga can use.");
    let Some(prefix) = Rights::find() else { return Err(advice()) };
    println!("Installing Mesa's software Vulkan driver ({}).", PACKAGES.join(", "));
    run(&mut prefix.apt_get(&["update"]))?;
    let install = ["install", "-y", "--no-install-recommends"];
    run(prefix.apt_get(&install).args(PACKAGES))?;
    if has_adapter(genga) {
        return Ok(());
    }
    Err(Error::new(
        "genga finds no graphics adapter even with Mesa's software Vulkan driver installed: \
         `genga adapters -v` says more",
    ))
}

fn has_adapter(genga: &Path) -> bool {
    succeeds(Command::new(genga).arg("adapters"))
}

fn advice() -> Error {
    let command = format!("apt-get install -y {}", PACKAGES.join(" "));
    Error::new(if succeeds(Command::new("apt-get").arg("--version")) {
        format!(
            "to draw without a GPU, install Mesa's software Vulkan driver and try again: `sudo {command}`"
        )
    } else {
        format!(
            "to draw without a GPU, install Mesa's software Vulkan driver (lavapipe) with your \
             system's package manager and try again; on Debian and Ubuntu that is `sudo {command}`"
        )
    })
}

/// How packages may be installed without a question.
#[derive(Clone, Copy)]
enum Rights {
    Root,
    Sudo,
}

impl Rights {
    fn find() -> Option<Self> {
        if !succeeds(Command::new("apt-get").arg("--version")) {
            return None;
        }
        let id = Command::new("id").arg("-u").output();
        if id.is_ok_and(|id| id.stdout.trim_ascii() == b"0") {
            return Some(Self::Root);
        }
        succeeds(Command::new("sudo").args(["-n", "true"])).then_some(Self::Sudo)
    }

    fn apt_get(self, arguments: &[&str]) -> Command {
        // `env` rather than `Command::env`, since sudo drops the environment.
        let mut command = match self {
            Self::Root => Command::new("env"),
            Self::Sudo => {
                let mut sudo = Command::new("sudo");
                sudo.args(["-n", "env"]);
                sudo
            }
        };
        command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get"]).args(arguments);
        command.stdin(std::process::Stdio::null());
        command
    }
}
