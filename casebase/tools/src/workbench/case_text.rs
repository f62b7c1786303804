//! `case_text`: a case file as text that is changed in place. Reads and writes the parts of a case in their
//! own form, tables or inline tables, and leaves comments, order and layout of all else.

use casebase::{GoalEnd, Presence};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::action_text::{ActionText, point};
use super::edit_error::EditError;
use super::part::Part;

/// A case file that is being changed.
#[derive(Debug)]
pub struct CaseText {
    document: DocumentMut,
}

impl CaseText {
    /// Reads a text; an error where it is not TOML.
    pub fn read(text: &str) -> Result<Self, EditError> {
        let document = text.parse();
        Ok(Self {
            document: document
                .map_err(|error: toml_edit::TomlError| EditError::Syntax(error.message().to_owned()))?,
        })
    }

    pub(super) fn text(&self) -> String {
        self.document.to_string()
    }

    /// Every part that can be there; an action may have no point.
    pub fn parts(&self) -> Vec<Part> {
        let robots = 1..=self.count("teammates");
        let actions = |robot| (1..=self.actions(robot).len()).map(move |number| Part::Action(robot, number));
        let mut parts = vec![Part::Ball];
        parts.extend(robots.flat_map(|robot| std::iter::once(Part::Robot(robot)).chain(actions(robot))));
        parts.extend((1..=self.count("opponents")).map(Part::Opponent));
        parts
    }

    /// Number of the case's robots.
    pub fn robots(&self) -> usize {
        self.count("teammates")
    }

    /// Number of the case's opponents.
    pub fn opponents(&self) -> usize {
        self.count("opponents")
    }

    /// The goal that is defended.
    pub fn defending(&self) -> Option<GoalEnd> {
        self.document.get("defending")?.as_str().and_then(GoalEnd::from_label)
    }

    /// Number of entries of a list: `teammates` or `opponents`.
    pub(super) fn count(&self, key: &str) -> usize {
        match self.document.get(key) {
            Some(Item::ArrayOfTables(tables)) => tables.len(),
            Some(Item::Value(Value::Array(array))) => array.len(),
            _ => 0,
        }
    }

    fn entry(&self, key: &str, number: usize) -> Option<&dyn TableLike> {
        let index = number.checked_sub(1)?;
        match self.document.get(key)? {
            Item::ArrayOfTables(tables) => tables.get(index).map(|table| table as &dyn TableLike),
            Item::Value(Value::Array(array)) => {
                array.get(index)?.as_inline_table().map(|table| table as &dyn TableLike)
            }
            _ => None,
        }
    }

    fn entry_mut(&mut self, key: &str, number: usize) -> Option<&mut dyn TableLike> {
        let index = number.checked_sub(1)?;
        match self.document.get_mut(key)? {
            Item::ArrayOfTables(tables) => tables.get_mut(index).map(|table| table as &mut dyn TableLike),
            Item::Value(Value::Array(array)) => {
                array.get_mut(index)?.as_inline_table_mut().map(|table| table as &mut dyn TableLike)
            }
            _ => None,
        }
    }

    fn table(&self, part: &Part) -> Option<&dyn TableLike> {
        match part {
            Part::Ball => self.document.get("ball")?.as_table_like(),
            Part::Robot(number) => self.entry("teammates", *number),
            Part::Opponent(number) => self.entry("opponents", *number),
            Part::Action(..) => None,
        }
    }

    /// The place of a part, mm.
    pub(super) fn point_of(&self, part: &Part) -> Option<[i32; 2]> {
        if let Part::Action(robot, number) = part {
            return self.action(*robot, *number).ok()?.point();
        }
        self.pair(part, "at")
    }

    /// Both radii of the scope of ball or opponent, mm.
    pub fn scope_of(&self, part: &Part) -> Option<[i32; 2]> {
        self.pair(part, "scope")
    }

    fn pair(&self, part: &Part, key: &str) -> Option<[i32; 2]> {
        let array = self.table(part)?.get(key)?.as_array()?;
        let number = |at: usize| i32::try_from(array.get(at)?.as_integer()?).ok();
        Some([number(0)?, number(1)?])
    }

    /// Sets a pair of numbers of ball, robot or opponent, in the layout that it has.
    pub(super) fn set_point(&mut self, part: &Part, key: &str, to: [i32; 2]) -> Result<(), EditError> {
        let none = || EditError::NoPart(format!("{key} of {part}"));
        let table = match part {
            Part::Ball => self.document.get_mut("ball").and_then(Item::as_table_like_mut),
            Part::Robot(number) => self.entry_mut("teammates", *number),
            Part::Opponent(number) => self.entry_mut("opponents", *number),
            Part::Action(..) => None,
        };
        let item = table.ok_or_else(none)?.get_mut(key).ok_or_else(none)?;
        match item.as_array_mut().filter(|array| array.len() == 2) {
            Some(array) => {
                for (index, mm) in to.into_iter().enumerate() {
                    array.replace(index, i64::from(mm));
                }
            }
            None => *item = Item::Value(point(to)),
        }
        Ok(())
    }

    /// Demand of an opponent's scope, counted from 1; without the key it ranks alone.
    pub fn presence_of(&self, opponent: usize) -> Option<Presence> {
        match self.table(&Part::Opponent(opponent))?.get("presence") {
            Some(item) => item.as_str().and_then(Presence::from_label),
            None => Some(Presence::default()),
        }
    }

    /// Sets what an opponent's scope demands; the default is written without the key.
    pub(super) fn set_presence(&mut self, opponent: usize, presence: Presence) -> Result<(), EditError> {
        let none = || EditError::NoPart(Part::Opponent(opponent).to_string());
        let table = self.entry_mut("opponents", opponent).ok_or_else(none)?;
        if presence == Presence::default() {
            table.remove("presence");
        } else if let Some(item) = table.get_mut("presence") {
            replace(item, presence.label());
        } else {
            table.insert("presence", Item::Value(Value::from(presence.label())));
        }
        Ok(())
    }

    /// Sets a text at the top level; its place, and a comment behind it, stay.
    pub(super) fn set_text(&mut self, key: &str, text: &str) {
        replace(&mut self.document[key], text);
    }

    fn gameplay(&mut self, robot: usize) -> Result<&mut Array, EditError> {
        let table = self.entry_mut("teammates", robot);
        let gameplay = table.and_then(|table| table.get_mut("gameplay")).and_then(Item::as_array_mut);
        gameplay.ok_or_else(|| EditError::NoPart(format!("gameplay of tm{robot}")))
    }

    /// The actions of a robot; what is none is left out.
    pub fn actions(&self, robot: usize) -> Vec<ActionText> {
        let gameplay = self.entry("teammates", robot).and_then(|table| table.get("gameplay")?.as_array());
        gameplay.map_or_else(Vec::new, |array| array.iter().filter_map(read).collect())
    }

    pub(super) fn action(&self, robot: usize, number: usize) -> Result<ActionText, EditError> {
        let gameplay = self.entry("teammates", robot).and_then(|table| table.get("gameplay")?.as_array());
        let value = gameplay.zip(number.checked_sub(1)).and_then(|(array, index)| array.get(index));
        value.and_then(read).ok_or_else(|| EditError::NoPart(Part::Action(robot, number).to_string()))
    }

    /// Puts an action in the place of one; its layout and comments stay.
    pub(super) fn set_action(
        &mut self,
        robot: usize,
        number: usize,
        action: &ActionText,
    ) -> Result<(), EditError> {
        let gameplay = self.gameplay(robot)?;
        let index = number.checked_sub(1).filter(|index| *index < gameplay.len());
        let index = index.ok_or_else(|| EditError::NoPart(Part::Action(robot, number).to_string()))?;
        gameplay.replace(index, action.value());
        Ok(())
    }

    /// Adds an action; its number afterwards is `number`, or the last one.
    pub(super) fn add_action(
        &mut self,
        robot: usize,
        number: usize,
        action: &ActionText,
    ) -> Result<(), EditError> {
        self.add_value(robot, number, action.value())
    }

    /// The same with an action that was taken out.
    pub(super) fn add_value(&mut self, robot: usize, number: usize, action: Value) -> Result<(), EditError> {
        let gameplay = self.gameplay(robot)?;
        let index = number.saturating_sub(1).min(gameplay.len());
        gameplay.insert(index, action);
        tidy(gameplay);
        Ok(())
    }

    pub(super) fn remove_action(&mut self, robot: usize, number: usize) -> Result<Value, EditError> {
        let gameplay = self.gameplay(robot)?;
        let index = number.checked_sub(1).filter(|index| *index < gameplay.len());
        let index = index.ok_or_else(|| EditError::NoPart(Part::Action(robot, number).to_string()))?;
        let mut action = gameplay.remove(index);
        action.decor_mut().clear();
        tidy(gameplay);
        Ok(action)
    }

    /// Adds a robot that waits, or an opponent with its scope, behind the others; an error where there are
    /// `most` already.
    pub(super) fn add_entry(
        &mut self,
        key: &str,
        most: usize,
        at: [i32; 2],
        scope: Option<[i32; 2]>,
    ) -> Result<(), ()> {
        if self.count(key) >= most {
            return Err(());
        }
        let (other, value) = match scope {
            Some(radii) => ("scope", point(radii)),
            None => ("gameplay", Value::Array(Array::from_iter(["wait"]))),
        };
        let pairs = [("at", point(at)), (other, value)];
        match self.document.get_mut(key) {
            Some(Item::Value(Value::Array(array))) => {
                array.push(Value::InlineTable(InlineTable::from_iter(pairs)));
                tidy(array);
            }
            Some(Item::ArrayOfTables(tables)) => tables.push(table(pairs)),
            _ => {
                self.document.insert(key, Item::ArrayOfTables(ArrayOfTables::from_iter([table(pairs)])));
            }
        }
        Ok(())
    }

    /// Takes a robot or an opponent out.
    pub(super) fn remove_entry(&mut self, key: &str, number: usize) -> Result<(), EditError> {
        let count = self.count(key);
        let Some(index) = number.checked_sub(1).filter(|_| number <= count) else {
            return Err(EditError::NoPart(format!("entry {number} of {key}")));
        };
        match self.document.get_mut(key) {
            Some(Item::Value(Value::Array(array))) => {
                array.remove(index);
                tidy(array);
            }
            Some(Item::ArrayOfTables(tables)) => {
                tables.remove(index);
                if tables.is_empty() {
                    self.document.remove(key);
                }
            }
            _ => {}
        }
        Ok(())
    }
}

/// Puts a text in the place of a value, in its layout.
fn replace(item: &mut Item, text: &str) {
    let mut value = Value::from(text);
    if let Some(old) = item.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

fn table(pairs: [(&str, Value); 2]) -> Table {
    let mut table = Table::new();
    for (key, value) in pairs {
        table.insert(key, Item::Value(value));
    }
    table.decor_mut().set_prefix("\n");
    table
}

fn read(value: &Value) -> Option<ActionText> {
    let mut value = value.clone();
    // Comments before it are not part of it.
    value.decor_mut().clear();
    value.to_string().parse().ok()
}

/// Returns whether there are lines or comments around a value.
fn has_layout(value: &Value) -> bool {
    let decor = value.decor();
    let around = [decor.prefix(), decor.suffix()];
    around.iter().flatten().filter_map(|raw| raw.as_str()).any(|text| !text.trim_matches(' ').is_empty())
}

/// One blank between the values of a list that stands on one line.
fn tidy(array: &mut Array) {
    // Where there are lines or comments their author's layout stays.
    if array.iter().any(has_layout) {
        return;
    }
    for (index, value) in array.iter_mut().enumerate() {
        value.decor_mut().set_prefix(if index == 0 { "" } else { " " });
        value.decor_mut().set_suffix("");
    }
}
