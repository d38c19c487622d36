use std::collections::BTreeMap;

use clamber_fight::Arena;

use crate::climber::{VERSION, common, hash, text, tick_seconds};
use crate::kind::Entries;
use crate::views::RESERVED;
use crate::{RecordError, RecordingInfo};

/// The metadata of a recording of an arena.
#[derive(Clone, Debug, PartialEq)]
pub struct ArenaInfo {
    /// [`Arena::config_hash`], to find out whether the arena's configuration has changed since.
    pub config: u64,
    /// Duration of a tick, seconds.
    pub tick_seconds: f64,
    /// Names of the first 1,000 creatures, by number, also of creatures that have left. Creatures with higher numbers,
    /// and those that join later, are called `creature N`.
    pub creatures: Vec<String>,
    /// Names of the fighters, by number, under the same rules as the creatures' names.
    pub fighters: Vec<String>,
    /// The caller's own entries about what the arena was made from: seed, options, files.
    pub settings: BTreeMap<String, String>,
    /// The version of this crate that wrote the recording. A recorder always writes its own.
    pub version: String,
}

impl ArenaInfo {
    /// The name of the metadata record that holds everything but the settings.
    pub const METADATA: &str = "clamber_arena";

    /// The metadata of an arena, with the names `creature 0`, `fighter 0` and so on, and without settings.
    pub fn of(arena: &Arena) -> Self {
        let named = |what: &str, count| (0..count).map(|n| format!("{what} {n}")).collect();
        let [creatures, fighters] = counts(arena);
        Self {
            config: arena.config_hash(),
            tick_seconds: arena.config().tick,
            creatures: named("creature", creatures),
            fighters: named("fighter", fighters),
            settings: BTreeMap::new(),
            version: RecordingInfo::VERSION.to_owned(),
        }
    }

    /// The name of a creature; `creature N` if it has none.
    pub fn creature(&self, number: usize) -> String {
        let name = self.creatures.get(number).cloned();
        name.unwrap_or_else(|| self.free(format!("creature {number}")))
    }

    /// The name of a fighter; `fighter N` if it has none.
    pub fn fighter(&self, number: usize) -> String {
        let name = self.fighters.get(number).cloned();
        name.unwrap_or_else(|| self.free(format!("fighter {number}")))
    }

    /// A name for a creature or fighter that joined later, with ` (joined)` added while another one has that name.
    fn free(&self, name: String) -> String {
        if self.creatures.contains(&name) || self.fighters.contains(&name) {
            self.free(format!("{name} (joined)"))
        } else {
            name
        }
    }

    /// Refuses names if their number does not fit the arena's creatures or fighters, or if a name is used twice or
    /// reserved: frames and entities of the recording are told apart by these names.
    pub(crate) fn check_names(&self, arena: &Arena) -> Result<(), RecordError> {
        let names = [("creatures", &self.creatures), ("fighters", &self.fighters)];
        for ((what, names), found) in names.into_iter().zip(counts(arena)) {
            let names = names.len();
            if names != found as usize {
                let problem = format!("there are {names} names for {found} {what}");
                return Err(RecordError::Names(problem));
            }
        }
        let all = self.creatures.iter().chain(&self.fighters);
        let mut all: Vec<&str> = all.map(String::as_str).collect();
        all.sort_unstable();
        if let Some(pair) = all.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(RecordError::Names(format!("two are called `{}`", pair[0])));
        }
        if let Some(name) = all.iter().find(|name| RESERVED.contains(name)) {
            let problem = format!("`{name}` is the name of something else in the recording");
            return Err(RecordError::Names(problem));
        }
        Ok(())
    }

    pub(crate) fn to_metadata(&self) -> Entries {
        let mut metadata = common(self.tick_seconds);
        metadata.insert("config".to_owned(), format!("{:016x}", self.config));
        for (what, names) in [("creature", &self.creatures), ("fighter", &self.fighters)] {
            let names = names.iter().enumerate();
            let entry =
                |(number, name): (usize, &String)| (format!("{what}.{number}"), name.clone());
            metadata.extend(names.map(entry));
        }
        metadata
    }

    pub(crate) fn from_metadata(
        metadata: &Entries,
        settings: Entries,
    ) -> Result<Self, RecordError> {
        let names = |what: &str| {
            let name = |number| metadata.get(&format!("{what}.{number}")).cloned();
            (0u32..).map_while(name).collect()
        };
        Ok(Self {
            config: hash(metadata, "config")?,
            tick_seconds: tick_seconds(metadata)?,
            creatures: names("creature"),
            fighters: names("fighter"),
            settings,
            version: text(metadata, VERSION)?.clone(),
        })
    }
}

/// How many creatures and fighters have names of their own, of those that the arena has had: the names of a state with
/// very high numbers would take too much memory.
fn counts(arena: &Arena) -> [u32; 2] {
    next(arena).map(|next| next.min(1000))
}

/// The numbers of the next creature and the next fighter.
pub(super) fn next(arena: &Arena) -> [u32; 2] {
    [arena.next_creature().0, arena.next_fighter().0]
}
