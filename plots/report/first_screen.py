"""The first screen of the page: three numbers, the chain of factors, and a picture."""
import math

from charts.chain import stages_of
from tables.results import FAULTS, NotMeasured
from tables.words import escaped, prose, shown

from .elements import element, elements, link_table


def card_element(card):
    """A number with its words; the sentence below says of what it is."""
    return element("li", element("strong", escaped(card.number), class_="figure")
                   + element("span", prose(card.words)) + element("p", prose(card.rest)))


def chain_element(results):
    """The stages of the chain as bars; the length goes with the logarithm of the factor."""
    try:
        stages = stages_of(results.table("chain", "stage", "role", "label", "base",
                                         "factor_vs_base"))
        stages = stages[stages["factor_vs_base"] > 0]
    except (NotMeasured, *FAULTS):  # the section of the chart says why
        return ""
    if stages.empty:
        return ""
    most = math.log(max(stages["factor_vs_base"].max(), 2))
    bars = []
    for _, row in stages.iterrows():
        width = max(100 * math.log(max(row["factor_vs_base"], 1)) / most, 1)
        bars.append(element("span", escaped(row["label"]))
                    + element("i", "", style=f"width:{width:.0f}%")
                    + element("b", shown(row["factor_vs_base"])))
    title = (f"Times as fast as {escaped(stages['base'].iloc[0])} after each stage of the chain. "
             f"The length of a bar is logarithmic. ({link_table('chain')})")
    return element("figure", element("figcaption", title)
                   + element("ol", elements("li", bars)), class_="stages")


def first_screen(results, cards, pictures):
    """The section with all of it. pictures: elements"""
    chain = chain_element(results)
    listed = element("ul", "".join(map(card_element, cards)), class_="cards") if cards else ""
    return element("section", listed
                   + element("div", chain + "".join(pictures), class_="beside"), id="summary",
                   aria_label="Summary")
