//! The reference of packet serial as `brushwork protocol` prints it.

use brushwork_mcp_wire::packet_serial::{Command, lookup, lookup_key, reference};

use crate::family::Page;

/// The whole page, or the commands that are named by number or key.
///
/// # Errors
/// A sentence: there is no such command.
pub fn page(names: &[String]) -> Result<Page, String> {
    let mut page = reference::reference();
    if names.is_empty() {
        return Ok(Page::new(&reference::page(), &page));
    }
    let wanted: Vec<_> = names.iter().map(|name| find(name)).collect::<Result<_, _>>()?;
    page.commands.retain(|row| wanted.iter().any(|command| command.number == row.number));
    let sections: Vec<_> =
        wanted.into_iter().map(|command| reference::section(command).trim_end().to_owned()).collect();
    Ok(Page::new(&sections.join("\n"), &page))
}

fn find(name: &str) -> Result<&'static Command, String> {
    name.parse().ok().and_then(lookup).or_else(|| lookup_key(name)).ok_or_else(|| {
        format!(
            "There is no command \"{name}\". Use a number such as 28 or a key such as {}; \
             `brushwork protocol` prints all.",
            lookup(28).map_or("read_version", |command| command.key)
        )
    })
}
