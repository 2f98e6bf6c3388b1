# SPDX-License-Identifier: Apache-2.0
"""Which voice a sentence has, and which of its words a reader looks up in the glossary.

Both are counts by rule, good to compare pages: a sentence is passive where a form of `be` stands before a participle
("the queue is emptied"), with at most two words between that are adverbs or `not`.
"""
import re

BE = {"am", "is", "are", "was", "were", "be", "been", "being"}
BETWEEN = re.compile(r"not|never|always|also|then|thus|still|only|even|once|again|often|hardly|yet|just|\w+ly")
PARTICIPLE = re.compile(r"\w{2,}ed")
NO_PARTICIPLE = {"need", "feed", "speed", "seed", "indeed", "hundred", "exceed", "proceed", "succeed", "overfeed"}
IRREGULAR = set("""begun bent bound bought broken brought built burnt caught chosen cut dealt done drawn driven fed felt found
given grown held heard hidden hit kept known laid led left lent let lost made meant met paid proven put read reset run said
seen sent set shown shut split spoilt spoken spread stuck struck taken taught thought thrown torn understood undone
wound woven written won""".split())


def plain(word):
    return re.sub(r"^\W+|\W+$", "", word.lower())


def is_passive(words):
    """Whether a sentence, given as its words, is in the passive voice."""
    bare = [plain(word) for word in words]
    for i, word in enumerate(bare):
        if word in BE:
            after = i + 1
            while after < min(i + 3, len(bare)) and BETWEEN.fullmatch(bare[after]):
                after += 1
            if after < len(bare) and bare[after] not in NO_PARTICIPLE and (
                    bare[after] in IRREGULAR or PARTICIPLE.fullmatch(bare[after])):
                return True
    return False


def terms_of(glossary):
    """The terms of the glossary page: of each row the terms of its first column, each as its words."""
    rows = re.findall(r"^\| ([^|]+) \|", glossary, re.M)
    terms = [tuple(plain(word) for word in term.split()) for row in rows for term in row.split(",")]
    return sorted({term for term in terms if term not in (("word",), ()) and term[0]}, key=len, reverse=True)


def is_term(words, term):
    """Whether these words are the term, in the singular or the plural."""
    return len(words) == len(term) and tuple(words[:-1]) == term[:-1] and words[-1] in (term[-1], f"{term[-1]}s", f"{term[-1]}es")


def count_of_terms(words, terms):
    """How many words of a sentence belong to terms. Terms with more words come first."""
    bare, count, i = [plain(word) for word in words], 0, 0
    while i < len(bare):
        length = next((len(term) for term in terms if is_term(bare[i:i + len(term)], term)), 0)
        count += length
        i += length or 1
    return count
